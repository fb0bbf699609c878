#pragma once

#include <algorithm>
#include <cmath>

#include "core/base/vec3.h"

namespace cscd {

// Returns the power of two that makes a number of this magnitude about 1, at least 2^-1000 and at most
// 2^1000. Products of several lengths neither overflow nor vanish in that scale. To scale by the power, and
// back, changes no digit, unless the result is subnormal.
inline double unit_scale(double magnitude) {
  int exponent = 0;
  std::frexp(magnitude, &exponent);
  return std::ldexp(1.0, std::clamp(-exponent, -1000, 1000));
}

// Returns the length of a vector, whose squares may overflow or vanish. The answer is the same wherever the
// vector lies in memory: Eigen's stableNorm() adds squares in an order that depends on it.
inline double stable_length(const Vec3& v) {
  const double scale = unit_scale(v.cwiseAbs().maxCoeff());
  return (scale * v).norm() / scale;
}

}  // namespace cscd
