#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/geometry/triple_product_lanes.h"
#include "core/hierarchy/tree.h"
#include "core/mesh/motion.h"
#include "core/mesh/triangle_mesh.h"

// Continuous normal cones (Tang, Curtis, Yoon and Manocha, TVCG 15(4), 2009): around every normal of a set of
// triangles at every t in [0, 1].
//
// The normal of a moving triangle is a quadratic in t and lies in the hull of its three Bernstein control
// vectors. A cone with a half angle below a right angle is convex, so it contains all normals when it
// contains those three.
namespace cscd::mcd {

// Angles are kept as cosine and sine, rounded so that the angle is never too small: the cosine down, the sine
// up.
struct NormalCone {
  Vec3 axis = Vec3::Zero();  // of length 1, but for rounding that the cosine pays for
  double cosine = -1;        // of the half angle; not positive where no cone below a right angle is known
  double sine = 1;

  // Every normal has a positive dot product with the axis.
  bool in_half_space() const { return cosine > 0; }
};

// Around three control vectors, each off by a rounding error that 64 u `area` bounds.
NormalCone cone_around(const std::array<Vec3, 3>& control, double area);

// Around two cones. The axis between them is as good a choice as it is cheap; the angle is then measured to
// both.
NormalCone merged(const NormalCone& a, const NormalCone& b);

// The cone of every node of a tree.
class NormalCones {
 public:
  NormalCones(const TriangleMesh& mesh, const Tree& tree);

  // O(triangles), no allocation.
  void update(const Tree& tree, const Motion& motion);

  const NormalCone& operator[](NodeIndex node) const { return node_[static_cast<std::size_t>(node)]; }

 private:
  struct LeafLanes {
    std::array<NodeIndex, kLanes> node;
    std::array<VertexLanes, 3> corner;
  };
  std::vector<LeafLanes> lanes_;  // a short last one repeats its last leaf
  std::vector<NormalCone> node_;
};

}  // namespace cscd::mcd
