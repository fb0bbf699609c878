#include "scenes/catalog/nearness.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/error.h"
#include "scenes/catalog/triangle_distance.h"

namespace cscd::scenes {
namespace {

constexpr float kUnreached = std::numeric_limits<float>::infinity();
// Nodes with more triangles are too wide for their extent to be of use, and get none.
constexpr std::size_t kLargestExtent = 512;

// Returns a lower bound of the distance between the contents of two volumes, whatever its rounding.
double gap(const Kdop16& a, const Kdop16& b) {
  constexpr double axis = 1 - 1e-6, diagonal = 0.7071;  // a little less than 1 / the directions' lengths
  double widest = 0;
  for (std::size_t k = 0; k < Kdop16::kDirections; ++k) {
    const double above = static_cast<double>(a.at_least[k]) + b.at_least[8 + k];
    const double below = static_cast<double>(b.at_least[k]) + a.at_least[8 + k];
    widest = std::max(widest, (k < 3 ? axis : diagonal) * std::max(above, below));
  }
  return widest;
}

// The neighbours of each vertex along edges, with lengths in mean edge lengths.
struct EdgeGraph {
  struct Step {
    VertexId to;
    float length;
  };
  std::vector<std::size_t> first;
  std::vector<Step> steps;

  EdgeGraph(const TriangleMesh& mesh, std::span<const Vec3> reference, double mean_edge)
      : first(mesh.vertex_count() + 1), steps(2 * mesh.edge_count()) {
    for (const Edge& edge : mesh.edges())
      for (const VertexId end : edge) ++first[+end];
    std::size_t sum = 0;
    for (std::size_t& offset : first) offset = (sum += offset);
    for (const Edge& edge : mesh.edges()) {
      const auto length = static_cast<float>((reference[+edge[0]] - reference[+edge[1]]).norm() / mean_edge);
      steps[--first[+edge[0]]] = {edge[1], length};
      steps[--first[+edge[1]]] = {edge[0], length};
    }
  }
  std::span<const Step> at(VertexId v) const {
    return std::span(steps).subspan(first[+v], first[+v + 1] - first[+v]);
  }
};

}  // namespace

Nearness::Nearness(const TriangleMesh& mesh, std::span<const Vec3> reference)
    : mesh_(mesh), tree_(build_tree(mesh, reference)), bounds_(mesh, tree_) {
  for (const Edge& edge : mesh.edges())
    mean_edge_ += (reference[+edge[0]] - reference[+edge[1]]).norm() / static_cast<double>(mesh.edge_count());
  if (mean_edge_ == 0)
    throw InputError("frame 0: all edges have length 0, so distances have no measure; repair the animation");
  find_neighbours(reference);
  find_extents(reference);
}

// Runs Dijkstra's algorithm from every vertex, up to paths of length kApartOnSurface.
void Nearness::find_neighbours(std::span<const Vec3> reference) {
  const EdgeGraph graph(mesh_, reference, mean_edge_);
  std::vector<float> path(mesh_.vertex_count(), kUnreached);
  std::vector<VertexId> reached;
  using Entry = std::pair<float, VertexId>;
  std::vector<Entry> storage;
  const auto later = [](const Entry& x, const Entry& y) { return x > y; };
  for (std::size_t v = 0; v < mesh_.vertex_count(); ++v) {
    const VertexId source{static_cast<std::int32_t>(v)};
    path[v] = 0;
    reached.assign(1, source);
    storage.assign(1, {0, source});
    while (!storage.empty()) {
      std::pop_heap(storage.begin(), storage.end(), later);
      const auto [done, at] = storage.back();
      storage.pop_back();
      if (done > path[+at]) continue;
      for (const EdgeGraph::Step& step : graph.at(at)) {
        const float length = done + step.length;
        if (length > kApartOnSurface || length >= path[+step.to]) continue;
        if (path[+step.to] == kUnreached) reached.push_back(step.to);
        path[+step.to] = length;
        storage.push_back({length, step.to});
        std::push_heap(storage.begin(), storage.end(), later);
      }
    }
    first_neighbour_.push_back(neighbours_.size());
    std::sort(reached.begin(), reached.end());
    for (const VertexId to : reached) {
      if (to > source) neighbours_.push_back({to, path[+to]});
      path[+to] = kUnreached;
    }
  }
  first_neighbour_.push_back(neighbours_.size());
}

void Nearness::find_extents(std::span<const Vec3> reference) {
  const std::size_t nodes = tree_.node_count();
  std::vector<std::size_t> end(nodes);  // of the node's subtree
  extents_.assign(nodes, {VertexId{0}, kUnreached});
  for (std::size_t node = nodes; node-- > 0;) {
    const auto index = static_cast<NodeIndex>(node);
    end[node] = tree_.is_leaf(index) ? node + 1 : end[static_cast<std::size_t>(tree_.right(index))];
    if (end[node] - node >= 2 * kLargestExtent) continue;
    Vec3 sum = Vec3::Zero();
    double count = 0;
    const auto for_corners = [&](const auto& take) {
      for (std::size_t below = node; below < end[node]; ++below)
        if (const auto leaf = static_cast<NodeIndex>(below); tree_.is_leaf(leaf))
          for (const VertexId corner : mesh_.corners(tree_.triangle(leaf))) take(corner);
    };
    for_corners([&](VertexId corner) { sum += reference[+corner], ++count; });
    double nearest = std::numeric_limits<double>::infinity();
    Extent& extent = extents_[node];
    for_corners([&](VertexId corner) {
      const double distance = (reference[+corner] - sum / count).squaredNorm();
      if (distance < nearest) nearest = distance, extent.centre = corner;
    });
    extent.reach = 0;
    for_corners([&](VertexId corner) { extent.reach = std::max(extent.reach, path(extent.centre, corner)); });
  }
}

float Nearness::path(VertexId a, VertexId b) const {
  if (a == b) return 0;
  if (a > b) std::swap(a, b);
  const auto begin = neighbours_.begin() + static_cast<std::ptrdiff_t>(first_neighbour_[+a]);
  const auto end = neighbours_.begin() + static_cast<std::ptrdiff_t>(first_neighbour_[+a + 1]);
  const auto found = std::lower_bound(
      begin, end, b, [](const Neighbour& row, VertexId vertex) { return row.vertex < vertex; });
  return found != end && found->vertex == b ? found->path : kUnreached;
}

bool Nearness::wholly_adjacent(NodeIndex a, NodeIndex b) const {
  const Extent &x = extents_[static_cast<std::size_t>(a)], &y = extents_[static_cast<std::size_t>(b)];
  const float reach = x.reach + y.reach;
  return reach <= kApartOnSurface && reach + path(x.centre, y.centre) <= kApartOnSurface;
}

bool Nearness::adjacent(TriangleId a, TriangleId b) const {
  for (const VertexId v : mesh_.corners(a))
    for (const VertexId w : mesh_.corners(b))
      if (path(v, w) <= kApartOnSurface) return true;
  return false;
}

struct Nearness::Search {
  const Nearness& in;
  std::span<const Vec3> x;
  double bound;  // in lengths of the scene; only a smaller distance counts
  std::optional<Pair> best;

  double distance(TriangleId a, TriangleId b) const {
    const auto corners = [&](TriangleId t) {
      const Triangle& c = in.mesh_.corners(t);
      return TriangleCorners{x[+c[0]], x[+c[1]], x[+c[2]]};
    };
    return triangle_distance(corners(a), corners(b));
  }
  double gap_of(NodeIndex a, NodeIndex b) const { return gap(in.bounds_[a], in.bounds_[b]); }

  void self(NodeIndex node) {
    if (in.tree_.is_leaf(node) || in.wholly_adjacent(node, node)) return;
    const NodeIndex left = in.tree_.left(node), right = in.tree_.right(node);
    self(left);
    self(right);
    pair(left, right, gap_of(left, right));
  }

  void pair(NodeIndex a, NodeIndex b, double gap) {
    if (gap >= bound || in.wholly_adjacent(a, b)) return;
    const Tree& tree = in.tree_;
    const bool leaf_a = tree.is_leaf(a), leaf_b = tree.is_leaf(b);
    if (leaf_a && leaf_b) return leaves(tree.triangle(a), tree.triangle(b));
    NodeIndex of_a[2] = {a, a}, of_b[2] = {b, b};
    if (!leaf_a) of_a[0] = tree.left(a), of_a[1] = tree.right(a);
    if (!leaf_b) of_b[0] = tree.left(b), of_b[1] = tree.right(b);
    struct Step {
      NodeIndex a, b;
      double gap;
    } steps[4];
    std::size_t count = 0;
    for (int i = 0; i < (leaf_a ? 1 : 2); ++i)
      for (int j = 0; j < (leaf_b ? 1 : 2); ++j) {  // sorted, nearest first
        const Step step{of_a[i], of_b[j], gap_of(of_a[i], of_b[j])};
        std::size_t at = count++;
        for (; at > 0 && steps[at - 1].gap > step.gap; --at) steps[at] = steps[at - 1];
        steps[at] = step;
      }
    for (std::size_t k = 0; k < count; ++k) pair(steps[k].a, steps[k].b, steps[k].gap);
  }

  void leaves(TriangleId a, TriangleId b) {
    if (in.adjacent(a, b)) return;
    if (b < a) std::swap(a, b);  // the distance may round differently for exchanged triangles
    const double found = distance(a, b);
    if (found >= bound) return;
    bound = found;
    best = Pair{a, b, found / in.mean_edge_};
  }
};

std::optional<Nearness::Pair> Nearness::closest(std::span<const Vec3> positions) {
  bounds_.refit(Motion(positions, positions));
  Search search{*this, positions, kFarthest * mean_edge_, std::nullopt};
  // The closest pair of the last frame bounds the distance in this one. The bound is a little above that
  // pair's distance, so that the search finds the pair by itself if it is still the closest. So the answer
  // depends on this frame alone (rule fresh-detector).
  if (last_) {
    const double known = search.distance(last_->a, last_->b);
    search.bound = std::min(search.bound, std::nextafter(known, std::numeric_limits<double>::infinity()));
  }
  search.self(0);
  last_ = search.best;
  return search.best;
}

}  // namespace cscd::scenes
