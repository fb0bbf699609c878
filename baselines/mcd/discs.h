#pragma once

#include <span>
#include <vector>

#include "core/hierarchy/tree.h"
#include "core/mesh/triangle_mesh.h"

namespace cscd::mcd {

// Finds the nodes of a tree below which the triangles form a disc, the pairs of neighbouring nodes whose
// triangles form a disc together, and the contours of both.
//
// The test only counts. Every edge belongs to at most two triangles, and two triangles run along it in
// opposite directions. The edges with one triangle form a single closed loop that visits no vertex
// twice. And vertices - edges + triangles is 1. This holds for discs, and for discs beside closed
// surfaces (or meeting them in vertices). The normals of a closed surface fit into no half space, so the
// normal cone refuses the latter.
class Discs {
 public:
  Discs(const TriangleMesh& mesh, const Tree& tree);

  // Returns the vertices of a node's contour in order, counter-clockwise seen from where the normals point
  // to. Empty if the triangles below the node form no disc.
  std::span<const VertexId> contour(NodeIndex node) const {
    return contour_number(static_cast<std::size_t>(node));
  }

  // Returns the contour of two nodes together. The nodes must have a common edge, be reached together by a
  // self-descent, and have a < b; for other nodes, and if they form no disc, the contour is empty.
  std::span<const VertexId> contour(NodeIndex a, NodeIndex b) const {
    const auto n = static_cast<std::size_t>(a);
    for (std::size_t i = first_partner_[n]; i < first_partner_[n + 1]; ++i)
      if (partner_[i] == b) return contour_number(first_partner_.size() - 1 + i);
    return {};
  }

 private:
  std::span<const VertexId> contour_number(std::size_t i) const {
    return std::span(vertices_).subspan(first_[i], first_[i + 1] - first_[i]);
  }
  std::vector<std::size_t> first_partner_;  // [nodes + 1]; start of each node's entries in partner_
  std::vector<NodeIndex> partner_;          // node with which the node forms a disc
  std::vector<std::size_t> first_;          // start of each contour, of nodes, then of partners; one more
  std::vector<VertexId> vertices_;
};

}  // namespace cscd::mcd
