#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#ifdef __AVX2__
#include <immintrin.h>
#endif

#include "core/geometry/simd_register.h"

namespace cscd {

// Eight doubles, or eight 64-bit integers, side by side.
inline constexpr std::size_t kLanes = 8;
using Lane8 = LanesOf<double>;
using Sign8 = LanesOf<std::int64_t>;

// The type of a comparison's result, for code that is written once for one number and for eight.
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

inline double absolute(double a) {
  return a < 0 ? -a : a;
}
inline Lane8 absolute(Lane8 a) {
  return bits_as<Lane8>(bits_as<Sign8>(a) & 0x7fff'ffff'ffff'ffff);
}

inline Lane8 square_root(Lane8 a) {
#ifdef __AVX512F__
  return _mm512_maskz_sqrt_pd(0xff, a);
#elif defined(__AVX2__)
  return {_mm256_sqrt_pd(a.low), _mm256_sqrt_pd(a.high)};
#else
  for (std::size_t l = 0; l < kLanes; ++l) a[l] = std::sqrt(a[l]);
  return a;
#endif
}

#ifdef __FMA__
// Returns a b + c, rounded once.
inline double rounded_once(double a, double b, double c) {
  return std::fma(a, b, c);
}
inline Lane8 rounded_once(Lane8 a, Lane8 b, Lane8 c) {
#ifdef __AVX512F__
  return _mm512_maskz_fmadd_pd(0xff, a, b, c);
#elif defined(__AVX2__)
  return {_mm256_fmadd_pd(a.low, b.low, c.low), _mm256_fmadd_pd(a.high, b.high, c.high)};
#else
  for (std::size_t l = 0; l < kLanes; ++l) a[l] = std::fma(a[l], b[l], c[l]);
  return a;
#endif
}
#endif

// Returns one bit for each lane: 1 if the lane is not 0.
inline unsigned bits_of(Sign8 lanes) {
#ifdef __AVX512F__
  return _mm512_test_epi64_mask(reinterpret_cast<__m512i>(lanes), reinterpret_cast<__m512i>(lanes));
#elif defined(__AVX2__)
  const auto half = [](HalfOf<std::int64_t> v) {
    return static_cast<unsigned>(_mm256_movemask_pd(reinterpret_cast<__m256d>(v != 0)));
  };
  return half(lanes.low) | half(lanes.high) << 4;
#else
  unsigned bits = 0;
  for (std::size_t l = 0; l < kLanes; ++l) bits |= static_cast<unsigned>(lanes[l] != 0) << l;
  return bits;
#endif
}

}  // namespace cscd
