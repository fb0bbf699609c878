#pragma once

#include <algorithm>
#include <cmath>

namespace cscd {

// Returns the power of two that makes a number of this magnitude about 1, at least 2^-1000 and at most
// 2^1000. Products of several lengths neither overflow nor vanish in that scale. To scale by the power, and
// back, changes no digit, unless the result is subnormal.
inline double unit_scale(double magnitude) {
  int exponent = 0;
  std::frexp(magnitude, &exponent);
  return std::ldexp(1.0, std::clamp(-exponent, -1000, 1000));
}

}  // namespace cscd
