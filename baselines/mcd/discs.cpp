#include "baselines/mcd/discs.h"

namespace cscd::mcd {
namespace {

// Scratch for one node after the other: what is not marked with the node's number is of an earlier one.
struct Collector {
  struct EdgeUse {
    NodeIndex node = -1;
    int triangles = 0;
    int direction = 0;  // triangles that run from the smaller index to the larger, less the others
    VertexId from{}, to{};
  };
  struct VertexUse {
    NodeIndex node = -1;
    int contour_edges = 0;  // that leave it
    VertexId next{};
  };
  const TriangleMesh& mesh;
  std::vector<EdgeUse> edge;
  std::vector<VertexUse> vertex;
  std::vector<EdgeId> edges;  // of the node

  explicit Collector(const TriangleMesh& mesh_in)
      : mesh(mesh_in), edge(mesh.edge_count()), vertex(mesh.vertex_count()) {}

  // Appends the contour to `out` if the triangles form a disc.
  void add_contour(NodeIndex node, std::span<const TriangleId> triangles, std::vector<VertexId>& out) {
    std::size_t vertices = 0, contour_edges = 0;
    edges.clear();
    for (const TriangleId t : triangles) {
      const Triangle& corner = mesh.corners(t);
      for (std::size_t k = 0; k < 3; ++k) {
        if (vertex[+corner[k]].node != node) {
          vertex[+corner[k]] = {node, 0, {}};
          ++vertices;
        }
        const EdgeId id = mesh.edges_of(t)[k];
        EdgeUse& use = edge[+id];
        if (use.node != node) {
          use = {node, 0, 0, {}, {}};
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
    // Each vertex of the contour has one way out of it, so walking from one of them may end in a loop that it
    // is not part of only if another vertex is entered twice, and then the loop is shorter than the contour.
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

}  // namespace

Discs::Discs(const TriangleMesh& mesh, const Tree& tree) {
  const auto nodes = static_cast<NodeIndex>(tree.node_count());
  std::vector<TriangleId> triangles;  // in tree order: those below a node stand together
  std::vector<std::size_t> leaves_before(tree.node_count() + 1);
  for (NodeIndex node = 0; node < nodes; ++node) {
    leaves_before[static_cast<std::size_t>(node)] = triangles.size();
    if (tree.is_leaf(node)) triangles.push_back(tree.triangle(node));
  }
  leaves_before.back() = triangles.size();

  Collector collector(mesh);
  for (NodeIndex node = 0; node < nodes; ++node) {
    first_.push_back(vertices_.size());
    if (tree.is_leaf(node)) continue;
    NodeIndex last = node;
    while (!tree.is_leaf(last)) last = tree.right(last);
    const std::size_t first_leaf = leaves_before[static_cast<std::size_t>(node)];
    const std::size_t leaves = leaves_before[static_cast<std::size_t>(last) + 1] - first_leaf;
    collector.add_contour(node, std::span(triangles).subspan(first_leaf, leaves), vertices_);
  }
  first_.push_back(vertices_.size());
}

}  // namespace cscd::mcd
