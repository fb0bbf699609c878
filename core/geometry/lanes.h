#pragma once

#include <cmath>
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

// For code that is written once for one number and for eight: what a comparison gives.
template <class Real>
struct ComparisonOf {
  using Mask = bool;
};
template <>
struct ComparisonOf<Lane8> {
  using Mask = Sign8;
};
template <class Real>
using MaskOf = typename ComparisonOf<Real>::Mask;

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

#ifdef __FMA__
// a b + c, rounded once.
inline double rounded_once(double a, double b, double c) {
  return std::fma(a, b, c);
}
inline Lane8 rounded_once(Lane8 a, Lane8 b, Lane8 c) {
#ifdef __AVX512F__
  return _mm512_maskz_fmadd_pd(0xff, a, b, c);
#else
  for (std::size_t l = 0; l < kLanes; ++l) a[l] = std::fma(a[l], b[l], c[l]);
  return a;
#endif
}
#endif

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
