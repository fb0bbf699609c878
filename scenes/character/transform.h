#pragma once

#include <array>

#include "core/base/vec3.h"

namespace cscd::scenes {

// An affine map x -> x0 column[0] + x1 column[1] + x2 column[2] + origin. Products are written out term by
// term: frames must be the same bits on every processor, and Eigen's matrix products are not.
struct Transform {
  std::array<Vec3, 3> column{Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()};
  Vec3 origin = Vec3::Zero();

  Vec3 direction(const Vec3& x) const { return x.x() * column[0] + x.y() * column[1] + x.z() * column[2]; }
  Vec3 operator()(const Vec3& x) const { return direction(x) + origin; }
  double determinant() const { return column[0].dot(column[1].cross(column[2])); }
  bool finite() const;
};

// x -> after(before(x)).
Transform composed(const Transform& after, const Transform& before);

// The map back; not finite where there is none.
Transform inverse(const Transform& map);

// A rotation as a unit quaternion.
struct Quaternion {
  double w = 1, x = 0, y = 0, z = 0;
};

// The unit quaternion of the same direction; the identity for zero or what is not finite.
Quaternion normalised(const Quaternion& q);

// The rotation at a share s in [0, 1] of the shorter way from a to b at constant angular speed (Shoemake,
// SIGGRAPH 1985), by halving the way until it is straight to 1e-12: square roots only, no sine.
Quaternion slerp(const Quaternion& a, const Quaternion& b, double s);

// Turns by `degrees` about the axes x, y and z; `order` lists these axes (0 to 2) in the order of turning.
Quaternion from_euler(const Vec3& degrees, const std::array<int, 3>& order);

// Scale, then rotate, then move.
Transform from_parts(const Vec3& move, const Quaternion& rotation, const Vec3& scale);

// The inverse of from_parts: the map without its move as a rotation and what is left to do before it. `rest`
// is triangular: scales on the diagonal (one of them negative for a mirroring), shears above it.
struct Parts {
  Vec3 move;
  Quaternion rotation;
  std::array<Vec3, 3> rest;  // columns
};
Parts parts_of(const Transform& map);

// Between two maps: rotations along the shorter way, everything else in straight lines. s = 0 gives a, s = 1
// gives b, exactly.
Transform blend(const Transform& a, const Transform& b, double s);

}  // namespace cscd::scenes
