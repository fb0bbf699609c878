#pragma once

#include <span>
#include <vector>

#include "core/geometry/kdop.h"
#include "core/hierarchy/tree.h"
#include "core/mesh/motion.h"
#include "core/mesh/triangle_mesh.h"

namespace cscd {

// Swept bounding volumes of every node of a tree over one interval.
template <class Volume>
class SweptVolumes {
 public:
  SweptVolumes(const TriangleMesh& mesh, const Tree& tree);

  // Bounds of all vertices' paths, then bottom-up over the tree; O(vertices + triangles), no allocation.
  void refit(const Motion& motion);

  const Volume& operator[](NodeIndex node) const { return node_[static_cast<std::size_t>(node)]; }

 private:
  struct Leaf {
    NodeIndex node;
    Triangle corners;
  };
  struct Inner {
    NodeIndex node, right;
  };
  // Backwards, so that children come first; by kind, as a branch on it would often be mispredicted.
  std::vector<Leaf> leaves_;
  std::vector<Inner> inner_;
  std::vector<Volume> vertex_, node_;
};
using SweptBounds = SweptVolumes<Kdop16>;
using SweptBoxes = SweptVolumes<Aabb>;

// The bounds of every vertex's path: vectorised over vertices, equal to what kdop_of and aabb_of give (their
// scalar twins). Only a zero may have the other sign, which no comparison sees.
void swept_vertex_bounds(const Motion& motion, std::span<Kdop16> out);
void swept_vertex_bounds(const Motion& motion, std::span<Aabb> out);

// The bounds of every triangle's path, of the bounds of its corners' paths.
template <class Volume>
Volume swept_triangle(const Triangle& corner, std::span<const Volume> of_vertex) {
  return united(united(of_vertex[+corner[0]], of_vertex[+corner[1]]), of_vertex[+corner[2]]);
}

}  // namespace cscd
