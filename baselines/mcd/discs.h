#pragma once

#include <span>
#include <vector>

#include "core/hierarchy/tree.h"
#include "core/mesh/triangle_mesh.h"

namespace cscd::mcd {

// The nodes of a tree below which the triangles form a disc, and its contour.
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
    const auto n = static_cast<std::size_t>(node);
    return std::span(vertices_).subspan(first_[n], first_[n + 1] - first_[n]);
  }

 private:
  std::vector<std::size_t> first_;  // of each node in vertices_, one more at the end
  std::vector<VertexId> vertices_;
};

}  // namespace cscd::mcd
