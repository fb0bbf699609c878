#pragma once

#include <cstddef>
#include <cstdint>
#ifdef __AVX512F__
#include <immintrin.h>
#endif

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
inline double absolute(double a) {
  return a < 0 ? -a : a;
}
inline Lane8 absolute(Lane8 a) {
  return reinterpret_cast<Lane8>(reinterpret_cast<Sign8>(a) & 0x7fff'ffff'ffff'ffff);
}

// One bit a lane: where it is not 0.
inline unsigned bits_of(Sign8 lanes) {
#ifdef __AVX512F__
  return _mm512_test_epi64_mask(reinterpret_cast<__m512i>(lanes), reinterpret_cast<__m512i>(lanes));
#else
  unsigned bits = 0;
  for (std::size_t l = 0; l < kLanes; ++l) bits |= static_cast<unsigned>(lanes[l] != 0) << l;
  return bits;
#endif
}

}  // namespace cscd
