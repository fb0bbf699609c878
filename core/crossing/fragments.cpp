#include "core/crossing/fragments.h"

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "core/base/disjoint_sets.h"
#include "core/base/sort_unique.h"
#include "core/crossing/self_winding.h"

namespace cscd {
namespace {

// A forest that spans the mesh, of each component breadth first.
std::vector<CurveMarks::Branch> forest_of(const TriangleMesh& mesh) {
  std::vector<CurveMarks::Branch> forest;
  forest.reserve(mesh.vertex_count());
  std::vector<std::uint8_t> is_reached(mesh.vertex_count(), 0);
  const auto reach = [&](VertexId v, VertexId from, EdgeId edge) {
    if (std::exchange(is_reached[+v], 1) == 0) forest.push_back({v, from, edge});
  };
  for (std::size_t root = 0, i = 0; root < mesh.vertex_count(); ++root) {
    reach(VertexId{static_cast<std::int32_t>(root)}, VertexId{-1}, EdgeId{-1});
    for (; i < forest.size(); ++i) {
      const VertexId from = forest[i].vertex;
      for (const TriangleId t : mesh.triangles_at(from))
        for (const EdgeId edge : mesh.edges_of(t))
          if (const Edge& ends = mesh.ends(edge); ends[0] == from || ends[1] == from)
            reach(ends[0] == from ? ends[1] : ends[0], from, edge);
    }
  }
  return forest;
}

}  // namespace

CurveMarks::CurveMarks(const TriangleMesh& mesh) : is_open(index(mesh.component_count()), false) {
  for (std::size_t e = 0; e < mesh.edge_count(); ++e) {
    const EdgeId id{static_cast<std::int32_t>(e)};
    const std::span<const TriangleId> both = mesh.triangles_at(id);
    const auto runs_forward = [&](TriangleId t) {
      const Triangle& c = mesh.corners(t);
      const auto first = std::ranges::find(c, mesh.ends(id)[0]) - c.begin();
      return c[static_cast<std::size_t>((first + 1) % 3)] == mesh.ends(id)[1];
    };
    if (both.size() == 2 && runs_forward(both[0]) != runs_forward(both[1])) continue;
    for (const TriangleId t : both) is_open[index(mesh.component(t))] = true;
  }
}

void CurveMarks::prepare(const TriangleMesh& mesh) {
  if (!branch.empty()) return;
  pierced.resize(mesh.edge_count(), kNone);
  is_on_curve.resize(mesh.vertex_count(), 0);
  is_cut.resize(mesh.triangle_count(), 0);
  const auto component = [&](TriangleId t) { return mesh.component(t); };
  by_component.clear();
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t)
    by_component.push_back(TriangleId{static_cast<std::int32_t>(t)});
  std::ranges::stable_sort(by_component, {}, component);
  first_of_component.clear();
  for (std::int32_t c = 0; c <= mesh.component_count(); ++c)
    first_of_component.push_back(static_cast<std::size_t>(
        std::ranges::lower_bound(by_component, c, {}, component) - by_component.begin()));
  forest = forest_of(mesh);
  branch.resize(mesh.vertex_count());
}

void Fragments::find() {
  marks_.prepare(mesh_);
  set_marks();
  cut();
  join();
}

void Fragments::set_marks() {
  for (std::size_t p = crossing_.piercings.size(); p-- > 0;)
    marks_.pierced[+crossing_.piercings[p].edge] = static_cast<std::int32_t>(p);
  for (const CrossingCurve& curve : crossing_.curves) {
    for (const auto& pair : curve.segments)
      for (const TriangleId t : pair) marks_.is_cut[+t] = 1;
    for (const CrossingCurve::Node& node : curve.nodes)
      if (node.piercing < 0) marks_.is_on_curve[+node.vertex] = 1;
  }
}

Fragments::~Fragments() {
  if (marks_.branch.empty()) return;  // no memory was left for marks
  for (const Piercing& p : crossing_.piercings) marks_.pierced[+p.edge] = kNone;
  for (const CrossingCurve& curve : crossing_.curves) {
    for (const auto& pair : curve.segments)
      for (const TriangleId t : pair) marks_.is_cut[+t] = 0;
    for (const CrossingCurve::Node& node : curve.nodes)
      if (node.piercing < 0) marks_.is_on_curve[+node.vertex] = 0;
  }
}

// Cuts the forest at pierced edges, and joins branches by the other edges that nothing pierces.
void Fragments::cut() {
  std::vector<std::int32_t> parent, trees;  // [branches]; the first branch of each tree
  const auto is_whole = [&](EdgeId edge, VertexId a, VertexId b) {
    return marks_.pierced[+edge] < 0 && !is_on_curve(a) && !is_on_curve(b);
  };
  for (const auto& [vertex, from, edge] : marks_.forest) {
    const bool is_root = from == VertexId{-1};
    if (!is_root && is_whole(edge, vertex, from)) {
      marks_.branch[+vertex] = marks_.branch[+from];
      --parent[index(marks_.branch[+from])];
      continue;
    }
    marks_.branch[+vertex] = static_cast<std::int32_t>(parent.size());
    if (is_root) trees.push_back(marks_.branch[+vertex]);
    parent.push_back(-1);
  }
  const std::span<const Edge> edges = mesh_.edges();
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto [a, b] = edges[e];
    if (marks_.branch[+a] != marks_.branch[+b] && is_whole(EdgeId{static_cast<std::int32_t>(e)}, a, b))
      unite(parent, marks_.branch[+a], marks_.branch[+b]);
  }
  fragment_.assign(parent.size(), kNone);
  std::int32_t first = 0;
  for (std::size_t i = 0, tree = 0; i < parent.size(); ++i) {
    if (tree < trees.size() && index(trees[tree]) == i)
      first = static_cast<std::int32_t>(size_.size()), ++tree;
    const std::size_t root = index(root_of(parent, static_cast<std::int32_t>(i)));
    if (fragment_[root] == kNone) {
      fragment_[root] = static_cast<std::int32_t>(size_.size());
      size_.push_back(parent[root]);
      first_.push_back(first);
    }
    fragment_[i] = fragment_[root];
  }
}

std::int32_t Fragments::end_of_tree(std::int32_t first) const {
  return static_cast<std::int32_t>(std::ranges::upper_bound(first_, first) - first_.begin());
}

// For each pair of components, joins the fragments of one that the other component does not part: those at
// both ends of an edge that its faces do not part.
void Fragments::join() {
  const std::vector<Piercing>& all = crossing_.piercings;
  std::vector<std::pair<Group, std::int32_t>> at;  // a group, and the first fragment of its tree
  for (const Piercing& p : all) {
    const Group group{component(p.edge), mesh_.component(p.face)};
    if (at.empty() || at.back().first != group) at.emplace_back(group, first_[index(fragment(p.behind))]);
  }
  sort_unique(at);
  for (const auto& [group, first] : at) {
    groups_.push_back(group);
    parts_.push_back({first, {size_.begin() + first, size_.begin() + end_of_tree(first)}});
  }
  for (std::size_t p = 0; p < all.size(); ++p) {
    if (p > 0 && all[p].edge == all[p - 1].edge) continue;
    if (is_on_curve(all[p].behind) || is_on_curve(all[p].before)) continue;
    const std::int32_t own = component(all[p].edge);
    const Group first_of_own{own, 0};
    for (auto g = static_cast<std::size_t>(std::ranges::lower_bound(groups_, first_of_own) - groups_.begin());
         g < groups_.size() && groups_[g].own == own; ++g) {
      if (parting(all[p].edge, groups_[g].other).parts()) continue;
      unite(parts_[g].parent, fragment(all[p].behind) - parts_[g].first,
            fragment(all[p].before) - parts_[g].first);
    }
  }
}

std::span<const Piercing> Fragments::piercings_of(EdgeId edge) const {
  const std::int32_t first = marks_.pierced[+edge];
  if (first < 0) return {};
  const auto from = crossing_.piercings.begin() + first;
  return {from,
          std::find_if(from, crossing_.piercings.end(), [&](const Piercing& p) { return p.edge != edge; })};
}

Fragments::Parting Fragments::parting(EdgeId edge, std::int32_t other) const {
  int balance = 0;  // of faces that have end 0 behind them
  const Edge& ends = mesh_.ends(edge);
  for (const Piercing& p : piercings_of(edge))
    if (mesh_.component(p.face) == other) balance += p.behind == ends[0] ? 1 : -1;
  if (marks_.is_open[index(other)]) balance %= 2;
  return {std::abs(balance), ends[balance > 0 ? 0 : 1], ends[balance > 0 ? 1 : 0]};
}

std::size_t Fragments::group_of(const Piercing& p) const {
  const Group group{component(p.edge), mesh_.component(p.face)};
  return static_cast<std::size_t>(std::ranges::lower_bound(groups_, group) - groups_.begin());
}

std::int32_t Fragments::part_of(std::size_t group, VertexId v) {
  Parts& parts = parts_[group];
  return root_of(parts.parent, fragment(v) - parts.first);
}

std::optional<int> Fragments::winding(std::int32_t own, VertexId v) {
  const std::int32_t first = first_[index(fragment(v))];
  const auto [known, is_new] = windings_.try_emplace(own);
  if (is_new) known->second = windings_of(own, first);
  return known->second[index(fragment(v) - first)];
}

// The winding number is known at an outermost vertex, and one more for each of the component's faces behind
// which an edge leads from there.
std::vector<std::optional<int>> Fragments::windings_of(std::int32_t own, std::int32_t first) const {
  std::vector<WindingStep> steps;
  for (const Piercing& p : crossing_.piercings) {
    if (component(p.edge) != own || is_on_curve(p.behind) || is_on_curve(p.before)) continue;
    const Parting edge = parting(p.edge, own);
    steps.push_back({fragment(edge.before) - first, fragment(edge.behind) - first, edge.faces});
  }
  const std::optional<OutermostVertex> known = find_outermost_vertex(
      mesh_, exact_, marks_.triangles_of(own), [&](VertexId v) { return is_on_curve(v); });
  const std::size_t count = index(end_of_tree(first) - first);
  if (!known) return std::vector<std::optional<int>>(count);
  return spread_winding(count, steps, fragment(known->vertex) - first, known->winding);
}

bool Fragments::is_inward(std::int32_t component) {
  const auto [known, is_new] = inward_.try_emplace(component);
  if (is_new)
    known->second = faces_inward(mesh_, positions_, marks_.triangles_of(component),
                                 [&](VertexId v) { return is_on_curve(v); });
  return known->second;
}

}  // namespace cscd
