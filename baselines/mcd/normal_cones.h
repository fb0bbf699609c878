#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/base/pipeline.h"
#include "core/geometry/triple_product_lanes.h"
#include "core/hierarchy/tree.h"
#include "core/mesh/motion.h"
#include "core/mesh/triangle_mesh.h"

// Continuous normal cones (Tang, Curtis, Yoon and Manocha, TVCG 15(4), 2009). Such a cone contains every
// normal of a set of triangles at every t in [0, 1].
//
// The normal of a moving triangle is a quadratic in t, so it lies in the hull of its three Bernstein
// control vectors. A cone with a half angle below a right angle is convex, so it contains all
// normals if it contains those three.
namespace cscd::mcd {

// A cone of directions. Its half angle is stored as cosine and sine, rounded so that the angle is never too
// small: the cosine down, the sine up.
struct NormalCone {
  Vec3 axis = Vec3::Zero();  // of length 1, up to a rounding that the cosine pays for
  double cosine = -1;        // of the half angle; not positive if no cone below a right angle is known
  double sine = 1;

  // Returns whether every normal has a positive dot product with the axis.
  bool in_half_space() const { return cosine > 0; }
};

// Returns a cone around three control vectors (the middle one may be stored twice as large). Each of
// them may be off by 64 u `area`.
NormalCone cone_around(const std::array<Vec3, 3>& control, double area);

// Returns a cone around two cones. Its axis lies between theirs, which is cheap and good enough; its half
// angle is then measured to both.
NormalCone merged(const NormalCone& a, const NormalCone& b);

// The cones of all nodes of a tree.
class NormalCones {
 public:
  // In the pipeline `published`, normals are made by scalar code, one triangle at a time. They have the same
  // bits. The mesh must outlive the cones.
  NormalCones(const TriangleMesh& mesh, const Tree& tree, Pipeline pipeline = Pipeline::vectorised);

  // Computes the cones for one interval. Linear in the number of triangles; allocates nothing. `tree` must
  // be the tree of the constructor.
  void update(const Tree& tree, const Motion& motion);

  const NormalCone& operator[](NodeIndex node) const { return node_[static_cast<std::size_t>(node)]; }

 private:
  struct LeafLanes {
    std::array<NodeIndex, kLanes> node;
    std::array<VertexLanes, 3> corner;
  };
  void update_leaves(const Motion& motion);
  void update_leaves_one_by_one(const Tree& tree, const Motion& motion);

  const TriangleMesh& mesh_;
  Pipeline pipeline_;
  std::vector<LeafLanes> lanes_;  // the last one may repeat its last leaf
  std::vector<NormalCone> node_;  // [nodes]
};

}  // namespace cscd::mcd
