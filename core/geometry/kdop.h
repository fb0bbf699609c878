#pragma once

#include <cstddef>

#include "core/base/rounding.h"
#include "core/base/vec3.h"
#include "core/mesh/motion.h"

namespace cscd {

// Bounding volume over eight directions: x, y, z, x+y, x+z, y+z, x-y, x-z, the usual reading of "16-DOP": the
// 18-DOP of Klosowski et al. 1998 without its last pair. Stored in float, every bound rounded outward from
// the exact projection.
//
// at_least[k] is a lower bound along direction k, at_least[8 + k] one along its negative, so a union is one
// componentwise minimum and fits one cache line.
struct alignas(64) Kdop16 {
  static constexpr std::size_t kDirections = 8;
  float at_least[2 * kDirections];
};

// Smallest Kdop16 that contains both.
inline Kdop16 united(const Kdop16& a, const Kdop16& b) {
  Kdop16 both;
  for (std::size_t k = 0; k < 16; ++k)
    both.at_least[k] = a.at_least[k] < b.at_least[k] ? a.at_least[k] : b.at_least[k];
  return both;
}

// Closed volumes: touching counts. False proves that nothing inside a touches anything inside b.
inline bool overlap(const Kdop16& a, const Kdop16& b) {
  int apart = 0;
  for (std::size_t k = 0; k < 8; ++k) {
    apart |= a.at_least[k] > -b.at_least[8 + k];
    apart |= b.at_least[k] > -a.at_least[8 + k];
  }
  return apart == 0;
}

// The bound of one point.
inline Kdop16 kdop_of(const Vec3& p) {
  const double x = p.x(), y = p.y(), z = p.z();
  return {{float_below(x), float_below(y), float_below(z), float_below_sum(x, y), float_below_sum(x, z),
           float_below_sum(y, z), float_below_sum(x, -y), float_below_sum(x, -z),  //
           float_below(-x), float_below(-y), float_below(-z), float_below_sum(-x, -y),
           float_below_sum(-x, -z), float_below_sum(-y, -z), float_below_sum(-x, y), float_below_sum(-x, z)}};
}

// The bound of a point's whole path: its two ends, as the path is straight.
inline Kdop16 kdop_of(const MovingPoint& p) {
  return united(kdop_of(p.start), kdop_of(p.end));
}

}  // namespace cscd
