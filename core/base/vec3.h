#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace cscd {

// A point or a vector in space, in lengths of the scene. An array of n Vec3 is a
// tightly packed array of 3 n doubles.
using Vec3 = Eigen::Vector3d;
static_assert(sizeof(Vec3) == 3 * sizeof(double));

}  // namespace cscd
