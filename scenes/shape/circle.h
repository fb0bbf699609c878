#pragma once

#include <cmath>
#include <numbers>

namespace cscd::scenes {

// A point of the unit circle.
struct CirclePoint {
  double cosine, sine;
};

// The point at an angle in turns. Its coordinates are rounded to multiples of 2^-40: the last bit of libm's
// functions depends on the processor (the variants with and without fused multiply-add differ), and frames
// must not.
inline CirclePoint circle_point(double turns) {
  constexpr double grid = 1099511627776.0;  // 2^40
  const double angle = 2 * std::numbers::pi * (turns - std::floor(turns));
  return {std::nearbyint(std::cos(angle) * grid) / grid, std::nearbyint(std::sin(angle) * grid) / grid};
}

}  // namespace cscd::scenes
