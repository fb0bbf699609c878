#pragma once

#include <cmath>

#include "core/base/vec3.h"

// Dual quaternion skinning (Kavan, Collins, Zara, O'Sullivan, "Geometric skinning with approximate dual
// quaternion blending", ACM TOG 27(4), 2008), without scale.
//
// Each vertex is carried by a rigid motion between the rigid motions of its bones. So a twisted limb keeps
// its thickness, while linear blending lets it collapse. Every quaternion stands for the same motion as its
// negative. The quaternion of a bone is taken with the sign that brings it nearer to the bone of the
// largest weight, so that blended quaternions never cancel out.
namespace cscd::scenes {

// A rigid motion as the unit quaternion (w, v) of its rotation and a dual part, or a weighted sum of such
// motions.
struct DualQuaternion {
  double w = 0;
  Vec3 v = Vec3::Zero();
  double dual_w = 0;
  Vec3 dual_v = Vec3::Zero();
};

// Returns the motion that turns by the unit quaternion (w, v) and then moves.
inline DualQuaternion rigid_motion(double w, const Vec3& v, const Vec3& move) {
  const Vec3 half = move / 2;
  return {w, v, -half.dot(v), w * half + half.cross(v)};
}

// Adds a motion to a sum by its weight, with the sign that brings it nearer to `pivot`.
inline void add_motion(DualQuaternion& sum, double weight, const DualQuaternion& motion,
                       const DualQuaternion& pivot) {
  if (pivot.w * motion.w + pivot.v.dot(motion.v) < 0) weight = -weight;
  sum.w += weight * motion.w;
  sum.v += weight * motion.v;
  sum.dual_w += weight * motion.dual_w;
  sum.dual_v += weight * motion.dual_v;
}

// Returns where the motion in the direction of a sum takes a point.
inline Vec3 carried(const DualQuaternion& sum, const Vec3& at) {
  const double length = std::sqrt(sum.w * sum.w + sum.v.dot(sum.v));
  const double w = sum.w / length, dual_w = sum.dual_w / length;
  const Vec3 v = sum.v / length, dual_v = sum.dual_v / length;
  return at + 2 * v.cross(v.cross(at) + w * at) + 2 * (w * dual_v - dual_w * v + v.cross(dual_v));
}

}  // namespace cscd::scenes
