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

// A 16-DOP of eight directions: x, y, z, x+y, x+z, y+z, x-y and x-z. This is the usual reading of "16-DOP":
// the 18-DOP of Klosowski et al. 1998 without its last pair of planes. It fills one cache line.
using Kdop16 = Slabs<8>;

// An axis-aligned box. Its fourth direction has length zero and pads the box to half a cache line.
using Aabb = Slabs<4>;

// Returns the smallest volume that contains both.
template <std::size_t N>
Slabs<N> united(const Slabs<N>& a, const Slabs<N>& b) {
  Slabs<N> both;
  for (std::size_t k = 0; k < 2 * N; ++k)
    both.at_least[k] = a.at_least[k] < b.at_least[k] ? a.at_least[k] : b.at_least[k];
  return both;
}

// Returns false only if nothing inside a touches anything inside b, which is then proven. Volumes are
// closed: volumes that touch overlap.
template <std::size_t N>
bool overlap(const Slabs<N>& a, const Slabs<N>& b) {
  int apart = 0;
  for (std::size_t k = 0; k < N; ++k) {
    apart |= a.at_least[k] > -b.at_least[N + k];
    apart |= b.at_least[k] > -a.at_least[N + k];
  }
  return apart == 0;
}

// Returns the bounds of one point.
inline Kdop16 kdop_of(const Vec3& p) {
  const double x = p.x(), y = p.y(), z = p.z();
  return {{float_below(x), float_below(y), float_below(z), float_below_sum(x, y), float_below_sum(x, z),
           float_below_sum(y, z), float_below_sum(x, -y), float_below_sum(x, -z),  //
           float_below(-x), float_below(-y), float_below(-z), float_below_sum(-x, -y),
           float_below_sum(-x, -z), float_below_sum(-y, -z), float_below_sum(-x, y), float_below_sum(-x, z)}};
}

// Returns the bounds of a point's whole path. The path is straight, so its two ends decide.
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
