#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>

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
#if defined(__AVX512F__)
  return _mm512_maskz_sqrt_pd(0xff, a);
#elif defined(__AVX2__)
  return Lane8::each([](auto r) { return _mm256_sqrt_pd(r); }, a);
#elif defined(__SSE2__)
  return Lane8::each([](auto r) { return _mm_sqrt_pd(r); }, a);
#elif defined(CSCD_NEON)
  return Lane8::each([](auto r) { return vsqrtq_f64(r); }, a);
#elif defined(__wasm_simd128__)
  return Lane8::each(
      [](auto r) { return reinterpret_cast<decltype(r)>(wasm_f64x2_sqrt(reinterpret_cast<v128_t>(r))); }, a);
#else
  for (std::size_t l = 0; l < kLanes; ++l) a[l] = std::sqrt(a[l]);
  return a;
#endif
}

#ifdef __FMA__  // a processor without it would call a function for each number
// Returns a b + c, rounded once.
inline double rounded_once(double a, double b, double c) {
  return std::fma(a, b, c);
}
inline Lane8 rounded_once(Lane8 a, Lane8 b, Lane8 c) {
#ifdef __AVX512F__
  return _mm512_maskz_fmadd_pd(0xff, a, b, c);
#elif defined(__AVX2__)
  return Lane8::each([](auto x, auto y, auto z) { return _mm256_fmadd_pd(x, y, z); }, a, b, c);
#else
  for (std::size_t l = 0; l < kLanes; ++l) a[l] = std::fma(a[l], b[l], c[l]);
  return a;
#endif
}
#endif

// Returns one bit for each lane: 1 if the lane is not 0.
inline unsigned bits_of(Sign8 lanes) {
#if defined(__AVX512F__)
  return _mm512_test_epi64_mask(reinterpret_cast<__m512i>(lanes), reinterpret_cast<__m512i>(lanes));
#elif defined(__AVX2__)
  const auto bits = [](RegisterOf<std::int64_t> v) {
    return static_cast<unsigned>(_mm256_movemask_pd(reinterpret_cast<__m256d>(v != 0)));
  };
  return bits(lanes.part[0]) | bits(lanes.part[1]) << 4;
#elif defined(__SSE2__)
  // SSE2 compares no integers of 64 bits. A lane is 0 if all its bytes are.
  const auto zero = [&](int i) {
    return _mm_cmpeq_epi32(reinterpret_cast<__m128i>(lanes.part[i]), _mm_setzero_si128());
  };
  const __m128i words = _mm_packs_epi16(_mm_packs_epi32(zero(0), zero(1)), _mm_packs_epi32(zero(2), zero(3)));
  const __m128i lanes_of_0 = _mm_cmpeq_epi16(words, _mm_set1_epi16(-1));
  return ~static_cast<unsigned>(_mm_movemask_epi8(_mm_packs_epi16(lanes_of_0, lanes_of_0))) & 0xff;
#elif defined(CSCD_NEON)
  const auto zero = [&](int i) {
    return vmovn_high_u64(vmovn_u64(vceqzq_s64(lanes.part[i])), vceqzq_s64(lanes.part[i + 1]));
  };
  const uint8x8_t lanes_of_0 = vmovn_u16(vmovn_high_u32(vmovn_u32(zero(0)), zero(2)));
  return static_cast<unsigned>(vaddv_u8(vand_u8(vmvn_u8(lanes_of_0), vcreate_u8(0x8040201008040201U))));
#elif defined(__wasm_simd128__)
  const auto zero = [&](int i) {
    return wasm_i64x2_eq(reinterpret_cast<v128_t>(lanes.part[i]), wasm_i64x2_const_splat(0));
  };
  const v128_t words = wasm_i8x16_narrow_i16x8(wasm_i16x8_narrow_i32x4(zero(0), zero(1)),
                                               wasm_i16x8_narrow_i32x4(zero(2), zero(3)));
  return ~wasm_i16x8_bitmask(words) & 0xff;
#else
  unsigned bits = 0;
  for (std::size_t l = 0; l < kLanes; ++l) bits |= static_cast<unsigned>(lanes[l] != 0) << l;
  return bits;
#endif
}

}  // namespace cscd
