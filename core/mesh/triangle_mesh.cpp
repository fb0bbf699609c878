#include "core/mesh/triangle_mesh.h"

#include <algorithm>
#include <bit>
#include <numeric>
#include <utility>

#include "core/base/error.h"
#include "core/base/number_text.h"

// Finds the connectivity of a triangle list by counting and small sorts. Every half-edge is put into the
// bucket of its smaller end. Each bucket is sorted by the larger end; neighbours with equal ends are one
// edge. So edges are numbered in the order of their ends, whatever the order of the triangles. The cost is
// linear, apart from the logarithm of the largest valence.

namespace cscd {
namespace {

constexpr std::size_t kLargest = std::size_t{1} << 28;  // three half-edges a triangle still fit into an int32

std::size_t index_of(std::int32_t i) {
  return static_cast<std::size_t>(i);
}
std::int32_t number(VertexId v) {
  return static_cast<std::int32_t>(v);
}
TriangleId triangle_id(std::size_t i) {
  return TriangleId{static_cast<std::int32_t>(i)};
}

std::string text(VertexId v) {
  return std::to_string(number(v));
}
std::string text(TriangleId t) {
  return std::to_string(static_cast<std::int32_t>(t));
}

std::string in_brackets(std::span<const VertexId> vertices) {
  std::string out;
  for (const VertexId v : vertices) out.append(out.empty() ? "(" : ", ").append(text(v));
  return out.append(")");
}
std::string text(const Edge& e) {
  return "edge " + in_brackets(e);
}
std::string text(const Triangle& c) {
  return in_brackets(c);
}

// Writes "triangles 1, 2 and 3". Long lists are cut.
std::string text(std::span<const TriangleId> triangles) {
  constexpr std::size_t shown = 6;
  std::string out = triangles.size() == 1 ? "triangle " : "triangles ";
  const std::size_t count = std::min(triangles.size(), shown);
  for (std::size_t i = 0; i < count; ++i) {
    const bool last = i + 1 == triangles.size();
    if (i > 0) out += last ? " and " : ", ";
    out += text(triangles[i]);
  }
  if (triangles.size() > shown) out += " and " + std::to_string(triangles.size() - shown) + " more";
  return out;
}

void require_triangle_list(std::span<const Triangle> triangles, std::size_t vertex_count,
                           const std::string& name) {
  if (vertex_count > kLargest || triangles.size() > kLargest)
    throw InputError(name + ": " + std::to_string(vertex_count) + " vertices and " +
                     std::to_string(triangles.size()) +
                     " triangles, but at most 2^28 of each are supported; " + "split the surface");
  if (triangles.empty()) throw InputError(name + ": has no triangles; give at least one");
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const Triangle& c = triangles[t];
    for (const VertexId v : c)
      if (number(v) < 0 || +v >= vertex_count)
        throw InputError(name + ": triangle " + std::to_string(t) + " names vertex " + text(v) +
                         ", outside [0, " + std::to_string(vertex_count) + "); indices count from 0");
    if (c[0] == c[1] || c[1] == c[2] || c[2] == c[0])
      throw InputError(name + ": triangle " + std::to_string(t) + " " + text(c) +
                       " repeats a corner; remove it");
  }
}

// Returns the corner of the triangle that is not an end of the edge.
VertexId opposite(const Triangle& c, const Edge& e) {
  for (const VertexId v : c)
    if (v != e[0] && v != e[1]) return v;
  return c[0];  // never reached: a triangle has three different corners
}

// Returns whether the triangle's corners run from the edge's smaller end to its larger end.
bool runs_upward(const Triangle& c, const Edge& e) {
  for (std::size_t k = 0; k < 3; ++k)
    if (c[k] == e[0]) return c[(k + 1) % 3] == e[1];
  return false;
}

// Counts the defects of one kind and describes the first of them.
class Tally {
 public:
  explicit Tally(Defect kind) : report_{kind, 0, {}} {}
  template <class Describe>
  void add(Describe&& describe) {
    if (report_.count++ == 0) report_.first = describe();
  }
  void append_to(std::vector<TriangleMesh::DefectReport>& out) {
    if (report_.count > 0) out.push_back(std::move(report_));
  }

 private:
  TriangleMesh::DefectReport report_;
};

}  // namespace

TriangleMesh::TriangleMesh(std::vector<Triangle> triangles, std::size_t vertex_count, const std::string& name)
    : vertex_count_(vertex_count), triangles_(std::move(triangles)) {
  require_triangle_list(triangles_, vertex_count_, name);
  build_edges();
  build_components();
  find_defects();
}

void TriangleMesh::build_edges() {
  const std::size_t half_edges = 3 * triangles_.size();

  at_vertex_.offset.assign(vertex_count_ + 1, 0);
  std::vector<std::int32_t> bucket(vertex_count_ + 1, 0);
  for (const Triangle& c : triangles_)
    for (std::size_t k = 0; k < 3; ++k) {
      ++at_vertex_.offset[+c[k] + 1];
      ++bucket[+std::min(c[k], c[(k + 1) % 3]) + 1];
    }
  std::partial_sum(at_vertex_.offset.begin(), at_vertex_.offset.end(), at_vertex_.offset.begin());
  std::partial_sum(bucket.begin(), bucket.end(), bucket.begin());

  struct HalfEdge {
    VertexId larger;
    std::int32_t index;  // 3 * triangle + k
    auto operator<=>(const HalfEdge&) const = default;
  };
  at_vertex_.items.resize(half_edges);
  std::vector<HalfEdge> sorted(half_edges);
  {
    std::vector<std::int32_t> next_triangle(at_vertex_.offset.begin(), at_vertex_.offset.end() - 1);
    std::vector<std::int32_t> next(bucket.begin(), bucket.end() - 1);
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
      const Triangle& c = triangles_[t];
      for (std::size_t k = 0; k < 3; ++k) {
        at_vertex_.items[index_of(next_triangle[+c[k]]++)] = triangle_id(t);
        const auto [smaller, larger] = std::minmax(c[k], c[(k + 1) % 3]);
        sorted[index_of(next[+smaller]++)] = {larger, static_cast<std::int32_t>(3 * t + k)};
      }
    }
  }

  triangle_edges_.resize(triangles_.size());
  edges_.reserve(half_edges / 2);
  at_edge_.offset.reserve(half_edges / 2 + 1);
  at_edge_.items.resize(half_edges);
  for (std::size_t v = 0; v < vertex_count_; ++v) {
    const std::size_t first = index_of(bucket[v]), last = index_of(bucket[v + 1]);
    std::sort(sorted.begin() + bucket[v], sorted.begin() + bucket[v + 1]);
    for (std::size_t i = first; i < last; ++i) {
      if (i == first || sorted[i].larger != sorted[i - 1].larger) {
        at_edge_.offset.push_back(static_cast<std::int32_t>(i));
        edges_.push_back({VertexId{static_cast<std::int32_t>(v)}, sorted[i].larger});
      }
      const std::size_t t = index_of(sorted[i].index / 3), k = index_of(sorted[i].index % 3);
      triangle_edges_[t][k] = EdgeId{static_cast<std::int32_t>(edges_.size() - 1)};
      at_edge_.items[i] = triangle_id(t);
    }
  }
  at_edge_.offset.push_back(static_cast<std::int32_t>(half_edges));
}

void TriangleMesh::build_components() {
  component_.assign(triangles_.size(), -1);
  std::vector<bool> vertex_seen(vertex_count_, false);
  std::vector<TriangleId> open;
  for (std::size_t seed = 0; seed < triangles_.size(); ++seed) {
    if (component_[seed] != -1) continue;
    component_[seed] = component_count_;
    open.push_back(triangle_id(seed));
    while (!open.empty()) {
      const TriangleId t = open.back();
      open.pop_back();
      for (const VertexId v : corners(t)) {
        if (vertex_seen[+v]) continue;
        vertex_seen[+v] = true;
        for (const TriangleId other : triangles_at(v)) {
          if (component_[+other] != -1) continue;
          component_[+other] = component_count_;
          open.push_back(other);
        }
      }
    }
    ++component_count_;
  }
}

void TriangleMesh::find_defects() {
  Tally duplicate(Defect::duplicate_triangle), non_manifold_edge(Defect::non_manifold_edge),
      boundary(Defect::boundary_edge), orientation(Defect::inconsistent_orientation),
      non_manifold_vertex(Defect::non_manifold_vertex);

  std::vector<std::pair<VertexId, TriangleId>> by_third;
  for (std::size_t i = 0; i < edges_.size(); ++i) {
    const Edge& e = edges_[i];
    const std::span<const TriangleId> around = triangles_at(EdgeId{static_cast<std::int32_t>(i)});

    if (around.size() == 1)
      boundary.add([&] {
        return text(e) + " of triangle " + text(around[0]) +
               " has no second triangle; close the hole or weld coinciding vertices";
      });
    if (around.size() > 2)
      non_manifold_edge.add([&] {
        return text(e) + " belongs to " + std::to_string(around.size()) + " triangles (" + text(around) +
               "); split it so that each surface has its own copy of its ends";
      });
    if (around.size() == 2 && runs_upward(corners(around[0]), e) == runs_upward(corners(around[1]), e))
      orientation.add([&] {
        return text(around) + " run through " + text(e) +
               " in the same direction; swap two corners of one of them";
      });

    // Triangles with the same corners share the edge between their two smallest corners. Looking only
    // there finds each such pair once.
    if (around.size() < 2) continue;
    by_third.clear();
    for (const TriangleId t : around)
      if (const VertexId third = opposite(corners(t), e); third > e[1]) by_third.emplace_back(third, t);
    std::sort(by_third.begin(), by_third.end());
    for (std::size_t k = 1; k < by_third.size(); ++k)
      if (by_third[k].first == by_third[k - 1].first)
        duplicate.add([&] {
          const TriangleId first = by_third[k - 1].second, second = by_third[k].second;
          return "triangles " + text(first) + " " + text(corners(first)) + " and " + text(second) + " " +
                 text(corners(second)) + " have the same corners; remove one of them";
        });
  }

  // A vertex is manifold if its triangles form one fan: all of them are reached from the first by crossing
  // edges at the vertex. At an end of a non-manifold edge, crossing that edge reaches all of its triangles,
  // so the vertex counts as a defect only if other triangles at it stay unreached.
  std::vector<std::int32_t> triangle_met(triangles_.size(), -1), edge_met(edges_.size(), -1);
  std::vector<TriangleId> open;
  for (std::size_t i = 0; i < vertex_count_; ++i) {
    const VertexId v{static_cast<std::int32_t>(i)};
    const std::span<const TriangleId> around = triangles_at(v);
    if (around.empty()) continue;
    std::size_t met = 1;
    triangle_met[+around[0]] = number(v);
    open.assign(1, around[0]);
    while (!open.empty()) {
      const TriangleId t = open.back();
      open.pop_back();
      for (const EdgeId e : edges_of(t)) {
        if (edge_met[+e] == number(v) || (ends(e)[0] != v && ends(e)[1] != v)) continue;
        edge_met[+e] = number(v);
        for (const TriangleId other : triangles_at(e)) {
          if (triangle_met[+other] == number(v)) continue;
          triangle_met[+other] = number(v);
          open.push_back(other);
          ++met;
        }
      }
    }
    if (met < around.size())
      non_manifold_vertex.add([&] {
        const auto apart = std::find_if(around.begin(), around.end(),
                                        [&](TriangleId t) { return triangle_met[+t] != number(v); });
        return "vertex " + text(v) + " joins triangles " + text(around[0]) + " and " + text(*apart) +
               " that no chain of edges at it connects; give each fan its own copy of the vertex";
      });
  }

  for (Tally* tally : {&duplicate, &non_manifold_edge, &boundary, &orientation, &non_manifold_vertex})
    tally->append_to(defects_);
}

void require_closed_and_oriented(const TriangleMesh& mesh, const std::string& who) {
  if (mesh.closed_and_oriented()) return;
  const auto noun = [](Defect kind) -> std::string {
    switch (kind) {
      case Defect::duplicate_triangle:
        return "duplicate triangles";
      case Defect::non_manifold_edge:
        return "non-manifold edges";
      case Defect::boundary_edge:
        return "boundary edges";
      case Defect::inconsistent_orientation:
        return "inconsistently oriented edges";
      case Defect::non_manifold_vertex:
        return "non-manifold vertices";
    }
    return "defects";
  };
  std::string counts;
  for (const TriangleMesh::DefectReport& defect : mesh.defects())
    counts += (counts.empty() ? "" : ", ") + noun(defect.kind) + ": " + std::to_string(defect.count);
  throw InputError(
      who + " needs a closed, manifold, consistently oriented surface: " + mesh.defects().front().first +
      " (" + counts + "); or use a strategy with guarantee complete");
}

namespace {

// Reads bits, because compilers take several numbers at a time then: a number is finite if its exponent is
// not all ones.
bool all_finite(std::span<const Vec3> positions) {
  constexpr std::uint64_t kExponent = std::uint64_t{0x7ff} << 52;
  const double* const numbers = positions.empty() ? nullptr : positions.front().data();
  std::uint64_t wrong = 0;
  for (std::size_t i = 0; i < 3 * positions.size(); ++i)
    wrong |= static_cast<std::uint64_t>((std::bit_cast<std::uint64_t>(numbers[i]) & kExponent) == kExponent);
  return wrong == 0;
}

}  // namespace

void require_finite(std::span<const Vec3> positions, const std::string& where) {
  if (all_finite(positions)) return;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const Vec3& p = positions[i];
    if (p.allFinite()) continue;
    throw InputError(where + ": vertex " + std::to_string(i) + " is at (" + exact_text(p.x()) + ", " +
                     exact_text(p.y()) + ", " + exact_text(p.z()) + "); every coordinate must be finite");
  }
}

}  // namespace cscd
