#include "baselines/mcd/discs.h"

#include <algorithm>
#include <compare>

#include "core/base/sort_unique.h"

namespace cscd::mcd {
namespace {

// Scratch memory that is used for one patch after another. An entry that is not marked with the patch's
// number belongs to an earlier patch. A *patch* here is the set of triangles below one node, or below two.
struct Collector {
  struct EdgeUse {
    int patch = 0;
    int triangles = 0;
    int direction = 0;  // triangles that run towards the larger index, minus the others
    VertexId from{}, to{};
  };
  struct VertexUse {
    int patch = 0;
    int contour_edges = 0;  // that leave the vertex
    VertexId next{};
  };
  const TriangleMesh& mesh;
  std::vector<EdgeUse> edge;
  std::vector<VertexUse> vertex;
  std::vector<EdgeId> edges;  // of the patch
  int patch = 0;

  explicit Collector(const TriangleMesh& mesh_in)
      : mesh(mesh_in), edge(mesh.edge_count()), vertex(mesh.vertex_count()) {}

  // Appends the contour of the triangles to `out` if they form a disc, else nothing.
  void add_contour(std::span<const TriangleId> triangles, std::vector<VertexId>& out) {
    ++patch;
    std::size_t vertices = 0, contour_edges = 0;
    edges.clear();
    for (const TriangleId t : triangles) {
      const Triangle& corner = mesh.corners(t);
      for (std::size_t k = 0; k < 3; ++k) {
        if (vertex[+corner[k]].patch != patch) {
          vertex[+corner[k]] = {patch, 0, {}};
          ++vertices;
        }
        const EdgeId id = mesh.edges_of(t)[k];
        EdgeUse& use = edge[+id];
        if (use.patch != patch) {
          use = {patch, 0, 0, {}, {}};
          edges.push_back(id);
        }
        use.from = corner[k], use.to = corner[(k + 1) % 3];
        use.direction += use.from < use.to ? 1 : -1;
        ++use.triangles;
      }
    }
    if (vertices + triangles.size() != edges.size() + 1) return;

    VertexId begin{};
    for (const EdgeId id : edges) {
      const EdgeUse& use = edge[+id];
      if (use.triangles > 2 || (use.triangles == 2 && use.direction != 0)) return;
      if (use.triangles == 2) continue;
      VertexUse& leaves = vertex[+use.from];
      if (++leaves.contour_edges > 1) return;
      leaves.next = begin = use.to;
      ++contour_edges;
    }
    // Each vertex of the contour has one way out. So a walk from one of the vertices can end in a
    // loop that does not contain that vertex only if another vertex is entered twice, and then the
    // loop is shorter than the contour.
    const std::size_t size_before = out.size();
    VertexId at = begin;
    for (std::size_t i = 0; i < contour_edges; ++i) {
      if (vertex[+at].contour_edges != 1 || (i > 0 && at == begin)) break;
      out.push_back(at);
      at = vertex[+at].next;
    }
    if (out.size() - size_before != contour_edges || at != begin) out.resize(size_before);
  }
};

struct NodePair {
  NodeIndex a, b;
  auto operator<=>(const NodePair&) const = default;
};

// Returns all pairs of nodes with a common edge to which a self-descent comes. They lie below the node at
// which the ways to the edge's two triangles part; the descent goes down both ways one step at a time.
std::vector<NodePair> neighbours(const TriangleMesh& mesh, const Tree& tree) {
  std::vector<NodeIndex> parent(tree.node_count(), -1), leaf(mesh.triangle_count());
  for (NodeIndex node = 0; node < static_cast<NodeIndex>(tree.node_count()); ++node) {
    if (tree.is_leaf(node)) {
      leaf[+tree.triangle(node)] = node;
    } else {
      parent[static_cast<std::size_t>(tree.left(node))] = node;
      parent[static_cast<std::size_t>(tree.right(node))] = node;
    }
  }
  const auto way_up = [&](NodeIndex node, std::vector<NodeIndex>& way) {
    way.clear();
    for (; node >= 0; node = parent[static_cast<std::size_t>(node)]) way.push_back(node);
  };

  std::vector<NodePair> pairs;
  std::vector<NodeIndex> a, b;
  for (std::size_t e = 0; e < mesh.edge_count(); ++e) {
    const std::span<const TriangleId> at = mesh.triangles_at(EdgeId{static_cast<std::int32_t>(e)});
    if (at.size() != 2) continue;  // with more, no disc; with fewer, no neighbours
    const auto [first, second] = std::minmax(leaf[+at[0]], leaf[+at[1]]);
    way_up(first, a);
    way_up(second, b);
    while (a.back() == b.back()) a.pop_back(), b.pop_back();
    for (;;) {
      pairs.push_back({a.back(), b.back()});
      if (a.size() == 1 && b.size() == 1) break;
      if (a.size() > 1) a.pop_back();
      if (b.size() > 1) b.pop_back();
    }
  }
  sort_unique(pairs);
  return pairs;
}

}  // namespace

Discs::Discs(const TriangleMesh& mesh, const Tree& tree) {
  const auto nodes = static_cast<NodeIndex>(tree.node_count());
  std::vector<TriangleId> triangles;  // in tree order, so that the triangles below a node stand together
  std::vector<std::size_t> leaves_before(tree.node_count() + 1);
  for (NodeIndex node = 0; node < nodes; ++node) {
    leaves_before[static_cast<std::size_t>(node)] = triangles.size();
    if (tree.is_leaf(node)) triangles.push_back(tree.triangle(node));
  }
  leaves_before.back() = triangles.size();
  const auto below = [&](NodeIndex node) {
    NodeIndex last = node;
    while (!tree.is_leaf(last)) last = tree.right(last);
    const std::size_t first_leaf = leaves_before[static_cast<std::size_t>(node)];
    return std::span<const TriangleId>(triangles).subspan(
        first_leaf, leaves_before[static_cast<std::size_t>(last) + 1] - first_leaf);
  };

  Collector collector(mesh);
  for (NodeIndex node = 0; node < nodes; ++node) {
    first_.push_back(vertices_.size());
    if (!tree.is_leaf(node)) collector.add_contour(below(node), vertices_);
  }
  std::vector<TriangleId> both;
  for (const auto& [a, b] : neighbours(mesh, tree)) {
    const std::size_t size_before = vertices_.size();
    const std::span<const TriangleId> of_a = below(a), of_b = below(b);
    both.assign(of_a.begin(), of_a.end());
    both.insert(both.end(), of_b.begin(), of_b.end());
    collector.add_contour(both, vertices_);
    if (vertices_.size() == size_before) continue;
    first_partner_.resize(static_cast<std::size_t>(a) + 1, partner_.size());
    partner_.push_back(b);
    first_.push_back(size_before);
  }
  first_partner_.resize(tree.node_count() + 1, partner_.size());
  first_.push_back(vertices_.size());
}

}  // namespace cscd::mcd
