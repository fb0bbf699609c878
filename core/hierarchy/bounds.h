#pragma once

#include <span>
#include <vector>

#include "core/base/pipeline.h"
#include "core/geometry/kdop.h"
#include "core/hierarchy/tree.h"
#include "core/mesh/motion.h"
#include "core/mesh/triangle_mesh.h"

namespace cscd {

// The bounds of the path of every node of a tree over one interval: each node's volume contains the paths
// of all triangles below the node.
template <class Volume>
class SweptVolumes {
 public:
  // In the pipeline `published`, bounds are made by scalar code, one vertex and one node at a time. They are
  // the same, except that a zero may have the other sign, which no comparison sees.
  SweptVolumes(const TriangleMesh& mesh, const Tree& tree, Pipeline pipeline = Pipeline::vectorised);

  // Computes the bounds of all vertices' paths, then of the nodes from the leaves upwards. O(vertices +
  // triangles); allocates nothing. With a margin, every path is as thick as a ball of that radius; the margin
  // is at least 0 and finite.
  void refit(const Motion& motion, double margin = 0);

  const Volume& operator[](NodeIndex node) const { return node_[static_cast<std::size_t>(node)]; }

 private:
  struct Leaf {
    NodeIndex node;
    Triangle corners;
  };
  struct Inner {
    NodeIndex node, right;
  };
  void refit_one_by_one(const Motion& motion, double margin);

  // Backwards, so that children come first. Leaves and inner nodes are treated apart, because a branch on the
  // kind would often be mispredicted.
  std::vector<Leaf> leaves_;
  std::vector<Inner> inner_;
  std::vector<Volume> vertex_, node_;  // [vertices], [nodes]
  Pipeline pipeline_;
};
using SweptBounds = SweptVolumes<Kdop16>;
using SweptBoxes = SweptVolumes<Aabb>;

// Computes the bounds of every vertex's path, vectorised over vertices. The results equal those of kdop_of
// and aabb_of, the scalar twins, except that a zero may have the other sign, which no comparison sees.
void swept_vertex_bounds(const Motion& motion, std::span<Kdop16> out);
void swept_vertex_bounds(const Motion& motion, std::span<Aabb> out);

// Thickens the bounds of a path by a ball of radius `margin`.
template <class Volume>
Volume thickened(Volume volume, double margin) {
  // Directions are at most sqrt(2) long. The sums are rounded outward, as the bounds are.
  for (float& bound : volume.at_least)
    bound = float_below_sum(static_cast<double>(bound), -1.4142135623731 * margin);
  return volume;
}

// Computes the bounds of every triangle's path from the bounds of its corners' paths.
template <class Volume>
Volume swept_triangle(const Triangle& corner, std::span<const Volume> of_vertex) {
  return united(united(of_vertex[+corner[0]], of_vertex[+corner[1]]), of_vertex[+corner[2]]);
}

}  // namespace cscd
