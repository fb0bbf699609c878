#pragma once

#include <array>

#include "core/base/vec3.h"

namespace cscd::scenes {

// An affine map x -> x0 column[0] + x1 column[1] + x2 column[2] + origin. Products are written out term by
// term because frames must have the same bits on every processor, and Eigen's matrix products differ
// between processors.
struct Transform {
  std::array<Vec3, 3> column{Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()};
  Vec3 origin = Vec3::Zero();

  Vec3 direction(const Vec3& x) const { return x.x() * column[0] + x.y() * column[1] + x.z() * column[2]; }
  Vec3 operator()(const Vec3& x) const { return direction(x) + origin; }
  double determinant() const { return column[0].dot(column[1].cross(column[2])); }
  bool finite() const;
};

// The map x -> after(before(x)).
Transform composed(const Transform& after, const Transform& before);

// The inverse map. Its numbers are not finite where `map` has no inverse.
Transform inverse(const Transform& map);

// A rotation as a unit quaternion.
struct Quaternion {
  double w = 1, x = 0, y = 0, z = 0;
};

// The unit quaternion in the direction of q. Returns the identity if q is zero or not finite.
Quaternion normalised(const Quaternion& q);

// The rotation that first does `before`, then `after`.
Quaternion product(const Quaternion& after, const Quaternion& before);

// Returns the rotation at the share s in [0, 1] of the shorter way from a to b, at constant angular speed
// (spherical linear interpolation: Shoemake, SIGGRAPH 1985). It halves the way until the rest is straight
// to 1e-12, which takes square roots only and no sine.
Quaternion slerp(const Quaternion& a, const Quaternion& b, double s);

// Returns the rotation that turns by degrees[k] about axis k (0 to 2 for x, y, z). `order` lists the axes
// in the order of turning.
Quaternion from_euler(const Vec3& degrees, const std::array<int, 3>& order);

// The map that scales, then rotates, then moves.
Transform from_trs(const Vec3& move, const Quaternion& rotation, const Vec3& scale);

// An affine map taken apart into translation, rotation and scale: x -> rotation(rest(x)) + move. `rest` is
// upper triangular: its diagonal holds scales (one of them negative for a map that mirrors), and shears stand
// above the diagonal.
struct Trs {
  Vec3 move;
  Quaternion rotation;
  std::array<Vec3, 3> rest;  // columns
};
// Takes a map apart; the inverse of from_trs where the map has no shear.
Trs trs_of(const Transform& map);

// Returns the map at the share s in [0, 1] between two maps. The rotation turns along the shorter way;
// everything else goes in straight lines. s = 0 gives exactly a, and s = 1 exactly b.
Transform blend(const Transform& a, const Transform& b, double s);

}  // namespace cscd::scenes
