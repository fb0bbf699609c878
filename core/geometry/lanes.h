#pragma once

#include <cstddef>
#include <cstdint>

namespace cscd {

// Eight numbers side by side, in the vector types that gcc and clang share: one AVX-512 register, or several
// smaller ones. Comparisons give -1 for true and 0 for false in each lane, and `mask ? a : b` selects lane by
// lane.
inline constexpr std::size_t kLanes = 8;
using Lane8 = double __attribute__((vector_size(kLanes * sizeof(double))));
using Sign8 = std::int64_t __attribute__((vector_size(kLanes * sizeof(std::int64_t))));

// Of one number too, for code that is written once for both.
template <class Real>
Real smaller(Real a, Real b) {
  return a < b ? a : b;
}
template <class Real>
Real larger(Real a, Real b) {
  return a < b ? b : a;
}
template <class Real>
Real absolute(Real a) {
  return a < 0 ? -a : a;
}

}  // namespace cscd
