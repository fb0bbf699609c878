#pragma once

#include <Eigen/Core>

#include "core/base/vec3.h"

namespace cscd::scenes {

// Products of rotations, term by term. Eigen's own fuse multiply and add where the processor can, whatever
// -ffp-contract says, and frames must be the same bits on every processor.
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

}  // namespace cscd::scenes
