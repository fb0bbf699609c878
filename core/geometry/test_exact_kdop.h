#pragma once

// Checks of 16-DOPs in rational arithmetic.

#include <array>
#include <cmath>
#include <cstddef>
#include <gmpxx.h>
#include <limits>

#include "core/geometry/kdop.h"

namespace cscd::test {

// Returns the exact projections of a point, in the order of Kdop16::at_least.
inline std::array<mpq_class, 16> projections(const Vec3& p) {
  const mpq_class x = p.x(), y = p.y(), z = p.z();
  std::array<mpq_class, 16> all{x, y, z, x + y, x + z, y + z, x - y, x - z};
  for (std::size_t k = 0; k < 8; ++k) all[8 + k] = -all[k];
  return all;
}

// Returns whether bound <= x, and false if `bound` is NaN.
inline bool at_most(float bound, const mpq_class& x) {
  constexpr float inf = std::numeric_limits<float>::infinity();
  return bound == -inf || (bound < inf && mpq_class(bound) <= x);
}

// Returns whether the volume contains a point, decided exactly.
inline bool contains(const Kdop16& volume, const Vec3& p) {
  const auto projection = projections(p);
  for (std::size_t k = 0; k < 16; ++k)
    if (!at_most(volume.at_least[k], projection[k])) return false;
  return true;
}

// Returns whether the volume contains a point's whole path. The path is straight and the volume
// is convex, so both ends decide.
inline bool contains(const Kdop16& volume, const MovingPoint& p) {
  return contains(volume, p.start) && contains(volume, p.end);
}

}  // namespace cscd::test
