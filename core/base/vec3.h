#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstring>
#include <span>

namespace cscd {

// A point or a vector in space, in lengths of the scene. An array of n Vec3 is a
// tightly packed array of 3 n doubles.
using Vec3 = Eigen::Vector3d;
static_assert(sizeof(Vec3) == 3 * sizeof(double));

// Returns whether two lists hold the same points, bit for bit; so 0 and -0 differ.
inline bool same_bits(std::span<const Vec3> a, std::span<const Vec3> b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size_bytes()) == 0);
}

}  // namespace cscd
