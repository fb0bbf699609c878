#pragma once

#include <span>
#include <vector>

#include "core/hierarchy/tree.h"
#include "core/mesh/triangle_mesh.h"

namespace cscd::mcd {

// The nodes of a tree below which the triangles form a disc, the pairs of neighbours that form one together,
// and the contours of both.
//
// The test is of counts alone: every edge is at most two triangles' and these run along it in opposite
// directions, the edges with one triangle form a single closed loop that visits no vertex twice, and
// vertices - edges + triangles is 1. This leaves discs, and discs beside (or meeting in vertices with) closed
// surfaces, among whose normals no half space holds them all: the normal cone refuses those.
class Discs {
 public:
  Discs(const TriangleMesh& mesh, const Tree& tree);

  // Corners of the contour in order, counter-clockwise seen from where the normals point to; empty where the
  // node is no disc.
  std::span<const VertexId> contour(NodeIndex node) const {
    return contour_number(static_cast<std::size_t>(node));
  }

  // The same for two nodes with an edge in common, a before b, that a self-descent comes to together; empty
  // for others.
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
  std::vector<std::size_t> first_partner_;  // of each node in partner_, one more at the end
  std::vector<NodeIndex> partner_;          // with which the node forms a disc
  std::vector<std::size_t> first_;          // of each contour: of the nodes, then of the partners; one more
  std::vector<VertexId> vertices_;
};

}  // namespace cscd::mcd
