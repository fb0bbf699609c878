#pragma once

#include <cstddef>

#include "core/base/rounding.h"
#include "core/base/vec3.h"
#include "core/mesh/motion.h"

namespace cscd {

// A bounding volume between pairs of parallel planes, one pair for each direction. It is stored in float, and
// every bound is rounded outward from the exact projection (rule outward-rounding, core/soundness.md).
//
// at_least[k] is a lower bound along direction k, and at_least[N + k] is one along its negative, so that a
// union is one componentwise minimum.
template <std::size_t N>
struct alignas(2 * N * sizeof(float)) Slabs {
  static constexpr std::size_t kDirections = N;
  float at_least[2 * N];
};

// Eight directions: x, y, z, x+y, x+z, y+z, x-y, x-z, the usual reading of "16-DOP": the 18-DOP of Klosowski
// et al. 1998 without its last pair. One cache line.
using Kdop16 = Slabs<8>;

// x, y, z, and a direction of length zero that makes it half a cache line.
using Aabb = Slabs<4>;

// Smallest volume that contains both.
template <std::size_t N>
Slabs<N> united(const Slabs<N>& a, const Slabs<N>& b) {
  Slabs<N> both;
  for (std::size_t k = 0; k < 2 * N; ++k)
    both.at_least[k] = a.at_least[k] < b.at_least[k] ? a.at_least[k] : b.at_least[k];
  return both;
}

// Closed volumes: touching counts. False proves that nothing inside a touches anything inside b.
template <std::size_t N>
bool overlap(const Slabs<N>& a, const Slabs<N>& b) {
  int apart = 0;
  for (std::size_t k = 0; k < N; ++k) {
    apart |= a.at_least[k] > -b.at_least[N + k];
    apart |= b.at_least[k] > -a.at_least[N + k];
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

inline Aabb aabb_of(const Vec3& p) {
  const double x = p.x(), y = p.y(), z = p.z();
  return {{float_below(x), float_below(y), float_below(z), 0,  //
           float_below(-x), float_below(-y), float_below(-z), 0}};
}
inline Aabb aabb_of(const MovingPoint& p) {
  return united(aabb_of(p.start), aabb_of(p.end));
}

}  // namespace cscd
