#pragma once

#include <span>
#include <vector>

#include "core/geometry/kdop.h"
#include "core/hierarchy/tree.h"
#include "core/mesh/motion.h"
#include "core/mesh/triangle_mesh.h"

namespace cscd {

// Swept 16-DOPs of every node of a tree over one interval.
class SweptBounds {
 public:
  SweptBounds(const TriangleMesh& mesh, const Tree& tree);

  // Bounds of all vertices' paths, then bottom-up over the tree; O(vertices + triangles), no allocation.
  void refit(const TriangleMesh& mesh, const Tree& tree, const Motion& motion);

  const Kdop16& operator[](NodeIndex node) const { return node_[static_cast<std::size_t>(node)]; }

 private:
  std::vector<Kdop16> vertex_, node_;
};

// The bounds of every vertex's path: vectorised over vertices, equal to what kdop_of gives (its scalar twin).
// Only a zero may have the other sign, which no comparison sees.
void swept_vertex_bounds(const Motion& motion, std::span<Kdop16> out);

}  // namespace cscd
