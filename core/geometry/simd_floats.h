#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#ifdef __AVX2__
#include <immintrin.h>
#endif

#include "core/geometry/simd_register.h"

namespace cscd {

// Sixteen floats side by side. Operations that the vector types of gcc and clang lack stand here twice, for
// AVX-512 and by halves: one instruction each where there is one, else a loop.
inline constexpr std::size_t kLanes16 = 16;
using Float16 = LanesOf<float>;
using Float8 = HalfOf<float>;
using Float4 = float __attribute__((vector_size(16)));
using Int16 = LanesOf<std::int32_t>;
using Int8 = HalfOf<std::int32_t>;
using Mask16 = std::uint16_t;  // one bit a lane
using Places16 = std::array<std::uint8_t, kLanes16>;

// Returns x in all lanes. (Compilers know that x - 0 is x, and leave the subtraction out. They cannot leave
// out x + 0, because it is not x if x is -0.)
inline Float16 all_lanes(float x) {
  return x - Float16{};
}

#ifndef __AVX512F__
// The lanes in which a comparison of a half is true.
inline unsigned bits_of(Int8 lanes) {
#ifdef __AVX2__
  return static_cast<unsigned>(_mm256_movemask_ps(reinterpret_cast<__m256>(lanes)));
#else
  unsigned bits = 0;
  for (unsigned l = 0; l < 8; ++l) bits |= static_cast<unsigned>(lanes[l] & 1) << l;
  return bits;
#endif
}
inline Mask16 bits_of(Int16 lanes) {
  return static_cast<Mask16>(bits_of(lanes.low) | bits_of(lanes.high) << 8);
}
#endif
inline Float16 absolute(Float16 a) {
  return bits_as<Float16>(bits_as<Int16>(a) & 0x7fffffff);
}

// a b + c and a b - c, rounded once where that is one instruction, else twice. Whoever bounds rounding has to
// allow for both.
inline Float16 product_plus(Float16 a, Float16 b, Float16 c) {
#ifdef __AVX512F__
  return _mm512_maskz_fmadd_ps(0xffff, a, b, c);
#elif defined(__AVX2__) && defined(__FMA__)
  return {_mm256_fmadd_ps(a.low, b.low, c.low), _mm256_fmadd_ps(a.high, b.high, c.high)};
#else
  return a * b + c;
#endif
}
inline Float16 product_minus(Float16 a, Float16 b, Float16 c) {
#ifdef __AVX512F__
  return _mm512_maskz_fmsub_ps(0xffff, a, b, c);
#elif defined(__AVX2__) && defined(__FMA__)
  return {_mm256_fmsub_ps(a.low, b.low, c.low), _mm256_fmsub_ps(a.high, b.high, c.high)};
#else
  return a * b - c;
#endif
}

// Returns the larger of the two absolute values in each lane.
inline Float16 larger_size(Float16 a, Float16 b) {
#ifdef __AVX512DQ__
  return _mm512_maskz_range_ps(0xffff, a, b, 0b1011);  // 11: the larger in size; 10: without its sign
#else
  return larger(absolute(a), absolute(b));
#endif
}

inline Float16 square_root(Float16 v) {
#ifdef __AVX512F__
  return _mm512_maskz_sqrt_ps(0xffff, v);
#elif defined(__AVX2__)
  return {_mm256_sqrt_ps(v.low), _mm256_sqrt_ps(v.high)};
#else
  for (std::size_t l = 0; l < kLanes16; ++l) v[l] = std::sqrt(v[l]);
  return v;
#endif
}

// Returns the lanes in which a > b.
inline Mask16 above(Float16 a, Float16 b) {
#ifdef __AVX512F__
  return _mm512_cmp_ps_mask(a, b, _CMP_GT_OQ);
#else
  return bits_of(a > b);
#endif
}

// Returns the lanes among those in `where` in which a > b.
inline Mask16 above(Mask16 where, Float16 a, Float16 b) {
#ifdef __AVX512F__
  return _mm512_mask_cmp_ps_mask(where, a, b, _CMP_GT_OQ);
#else
  return where & above(a, b);
#endif
}

// Visits the lanes of a mask, the first lane first.
template <class Take>
void for_each_lane(unsigned mask, const Take& take) {
  for (; mask != 0; mask &= mask - 1) take(static_cast<std::size_t>(std::countr_zero(mask)));
}

// Returns the lanes in which the numbers are the same.
inline Mask16 equal(const std::array<std::int32_t, kLanes16>& a,
                    const std::array<std::int32_t, kLanes16>& b) {
#ifdef __AVX512F__
  return _mm512_cmpeq_epi32_mask(_mm512_loadu_si512(a.data()), _mm512_loadu_si512(b.data()));
#else
  Int16 lanes[2];
  std::memcpy(&lanes[0], a.data(), sizeof lanes[0]);
  std::memcpy(&lanes[1], b.data(), sizeof lanes[1]);
  return bits_of(lanes[0] == lanes[1]);
#endif
}

// Combines all lanes by an operation on two vectors of any length, or on two numbers; halves are combined
// first.
template <class Operation>
float folded(Float16 v, const Operation& operation) {
  Float8 eight[2];
  std::memcpy(&eight, &v, sizeof v);
  eight[0] = operation(eight[0], eight[1]);
  Float4 four[2];
  std::memcpy(&four, &eight[0], sizeof four);
  four[0] = operation(four[0], four[1]);
  return operation(operation(four[0][0], four[0][1]), operation(four[0][2], four[0][3]));
}

// Lane l of the result is lane place[l] of v.
inline Float16 permuted(Float16 v, const Places16& place) {
#ifdef __AVX512F__
  // The intrinsics take masks of ones, because gcc 12 warns about the forms without a mask (GCC bug 105593).
  __m128i bytes;
  std::memcpy(&bytes, place.data(), sizeof bytes);
  return _mm512_maskz_permutexvar_ps(0xffff, _mm512_maskz_cvtepu8_epi32(0xffff, bytes), v);
#elif defined(__AVX2__)
  // Permute each half by the last three bits of the place, then choose the half by the fourth bit, moved to
  // the sign bit, where a blend reads it.
  const auto half = [&](const std::uint8_t* places) {
    const __m256i lanes = _mm256_cvtepu8_epi32(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(places)));
    return _mm256_blendv_ps(_mm256_permutevar8x32_ps(v.low, lanes), _mm256_permutevar8x32_ps(v.high, lanes),
                            _mm256_castsi256_ps(_mm256_slli_epi32(lanes, 28)));
  };
  return {half(place.data()), half(place.data() + 8)};
#else
  Float16 out;
  for (std::size_t l = 0; l < kLanes16; ++l) out[l] = v[place[l]];
  return out;
#endif
}

}  // namespace cscd
