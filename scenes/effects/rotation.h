#pragma once

#include <Eigen/Core>

#include "core/base/vec3.h"
#include "scenes/shape/circle.h"

namespace cscd::scenes {

// Products of rotations, term by term. Eigen's own products fuse multiply and add where the processor can,
// whatever -ffp-contract says, but frames must have the same bits on every processor.
inline Vec3 rotated(const Eigen::Matrix3d& r, const Vec3& v) {
  return {r(0, 0) * v.x() + r(0, 1) * v.y() + r(0, 2) * v.z(),
          r(1, 0) * v.x() + r(1, 1) * v.y() + r(1, 2) * v.z(),
          r(2, 0) * v.x() + r(2, 1) * v.y() + r(2, 2) * v.z()};
}

inline Eigen::Matrix3d composed(const Eigen::Matrix3d& after, const Eigen::Matrix3d& before) {
  Eigen::Matrix3d product;
  for (int column = 0; column < 3; ++column) product.col(column) = rotated(after, before.col(column));
  return product;
}

// The rotation about a unit vector, by an angle in turns. circle_point cuts off the last bits of the sine
// and cosine; the rotation is made orthogonal to the last bits again, because poses multiply many
// rotations.
inline Eigen::Matrix3d rotation_about(const Vec3& axis, double turns) {
  CirclePoint point = circle_point(turns);
  const double length = std::sqrt(point.cosine * point.cosine + point.sine * point.sine);
  point = {point.cosine / length, point.sine / length};
  Eigen::Matrix3d rotation;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column)
      rotation(row, column) = (1 - point.cosine) * axis[row] * axis[column];
  const Vec3 sine = point.sine * axis;
  rotation(0, 0) += point.cosine;
  rotation(1, 1) += point.cosine;
  rotation(2, 2) += point.cosine;
  rotation(0, 1) -= sine.z();
  rotation(1, 0) += sine.z();
  rotation(0, 2) += sine.y();
  rotation(2, 0) -= sine.y();
  rotation(1, 2) -= sine.x();
  rotation(2, 1) += sine.x();
  return rotation;
}

// The rotation about the direction of `vector`, by the length of `vector` in turns.
inline Eigen::Matrix3d rotation_by(const Vec3& vector) {
  const double turns = vector.norm();
  if (turns == 0) return Eigen::Matrix3d::Identity();
  return rotation_about(vector / turns, turns);
}

// The smallest rotation that takes one unit vector to another.
inline Eigen::Matrix3d smallest_rotation(const Vec3& from, const Vec3& to) {
  const Vec3 axis = from.cross(to);  // its length is the sine of the angle
  const double cosine = from.dot(to);
  if (cosine < -0.999999) {
    // Make a half turn about any axis perpendicular to `from`.
    int least = 0;
    from.cwiseAbs().minCoeff(&least);
    const Vec3 across = from.cross(Vec3::Unit(least)).normalized();
    return 2 * across * across.transpose() - Eigen::Matrix3d::Identity();
  }
  Eigen::Matrix3d cross;
  cross << 0, -axis.z(), axis.y(), axis.z(), 0, -axis.x(), -axis.y(), axis.x(), 0;
  return Eigen::Matrix3d::Identity() + cross + composed(cross, cross) / (1 + cosine);
}

}  // namespace cscd::scenes
