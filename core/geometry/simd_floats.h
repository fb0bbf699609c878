#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "core/geometry/simd_register.h"

namespace cscd {

// Sixteen floats side by side. Operations that the vector types of gcc and clang lack stand here once for
// each kind of register: one instruction each where there is one, else a loop.
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
// Returns the lanes in which a comparison is true.
inline Mask16 bits_of(const Int16& lanes) {
#if defined(__AVX2__)
  const auto bits = [](RegisterOf<std::int32_t> v) {
    return static_cast<unsigned>(_mm256_movemask_ps(reinterpret_cast<__m256>(v)));
  };
  return static_cast<Mask16>(bits(lanes.part[0]) | bits(lanes.part[1]) << 8);
#elif defined(__SSE2__)
  const auto packed = [&](int i) {
    return _mm_packs_epi32(reinterpret_cast<__m128i>(lanes.part[i]),
                           reinterpret_cast<__m128i>(lanes.part[i + 1]));
  };
  return static_cast<Mask16>(_mm_movemask_epi8(_mm_packs_epi16(packed(0), packed(2))));
#elif defined(CSCD_NEON)
  const auto packed = [&](int i) { return vmovn_high_s32(vmovn_s32(lanes.part[i]), lanes.part[i + 1]); };
  return bits_of_bytes(vreinterpretq_u8_s8(vmovn_high_s16(vmovn_s16(packed(0)), packed(2))));
#elif defined(__wasm_simd128__)
  const auto packed = [&](int i) { return wasm_i16x8_narrow_i32x4(lanes.part[i], lanes.part[i + 1]); };
  return static_cast<Mask16>(wasm_i8x16_bitmask(wasm_i8x16_narrow_i16x8(packed(0), packed(2))));
#else
  unsigned bits = 0;
  for (std::size_t l = 0; l < kLanes16; ++l) bits |= static_cast<unsigned>(lanes[l] & 1) << l;
  return static_cast<Mask16>(bits);
#endif
}
#endif
inline Float16 absolute(Float16 a) {
  return bits_as<Float16>(bits_as<Int16>(a) & 0x7fffffff);
}

// a b + c and a b - c, rounded once where that is one instruction, else twice. Whoever bounds rounding has to
// allow for both.
inline Float16 product_plus(Float16 a, Float16 b, Float16 c) {
#if defined(__AVX512F__)
  return _mm512_maskz_fmadd_ps(0xffff, a, b, c);
#elif defined(__AVX2__) && defined(__FMA__)
  return Float16::each([](auto x, auto y, auto z) { return _mm256_fmadd_ps(x, y, z); }, a, b, c);
#elif defined(CSCD_NEON)
  return Float16::each([](auto x, auto y, auto z) { return vfmaq_f32(z, x, y); }, a, b, c);
#else
  return a * b + c;
#endif
}
inline Float16 product_minus(Float16 a, Float16 b, Float16 c) {
#if defined(__AVX512F__)
  return _mm512_maskz_fmsub_ps(0xffff, a, b, c);
#elif defined(__AVX2__) && defined(__FMA__)
  return Float16::each([](auto x, auto y, auto z) { return _mm256_fmsub_ps(x, y, z); }, a, b, c);
#elif defined(CSCD_NEON)
  return Float16::each([](auto x, auto y, auto z) { return vfmaq_f32(-z, x, y); }, a, b, c);
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
#if defined(__AVX512F__)
  return _mm512_maskz_sqrt_ps(0xffff, v);
#elif defined(__AVX2__)
  return Float16::each([](auto r) { return _mm256_sqrt_ps(r); }, v);
#elif defined(__SSE2__)
  return Float16::each([](auto r) { return _mm_sqrt_ps(r); }, v);
#elif defined(CSCD_NEON)
  return Float16::each([](auto r) { return vsqrtq_f32(r); }, v);
#elif defined(__wasm_simd128__)
  return Float16::each(
      [](auto r) { return reinterpret_cast<decltype(r)>(wasm_f32x4_sqrt(reinterpret_cast<v128_t>(r))); }, v);
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
  return bits_of(loaded<Int16>(a.data()) == loaded<Int16>(b.data()));
#endif
}

// Combines all lanes by an operation on two vectors of any length, or on two numbers; halves are combined
// first.
template <class Operation>
float folded(const Float16& v, const Operation& operation) {
  const Float8 eight = operation(half_of<Float8, 0>(v), half_of<Float8, 1>(v));
  const Float4 four = operation(half_of<Float4, 0>(eight), half_of<Float4, 1>(eight));
  return operation(operation(four[0], four[1]), operation(four[2], four[3]));
}

// Lane l of the result is lane place[l] of v.
inline Float16 permuted(Float16 v, const Places16& place) {
#ifdef __AVX512F__
  // The intrinsics take masks of ones, because gcc 12 warns about the forms without a mask (GCC bug 105593).
  __m128i bytes;
  std::memcpy(&bytes, place.data(), sizeof bytes);
  return _mm512_maskz_permutexvar_ps(0xffff, _mm512_maskz_cvtepu8_epi32(0xffff, bytes), v);
#elif defined(__AVX2__)
  // Permute each register by the last three bits of the place, then choose the register by the fourth bit,
  // moved to the sign bit, where a blend reads it.
  const auto part = [&](std::size_t i) {
    const __m256i lanes =
        _mm256_cvtepu8_epi32(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(place.data() + 8 * i)));
    return _mm256_blendv_ps(_mm256_permutevar8x32_ps(v.part[0], lanes),
                            _mm256_permutevar8x32_ps(v.part[1], lanes),
                            _mm256_castsi256_ps(_mm256_slli_epi32(lanes, 28)));
  };
  Float16 out;
  out.part[0] = part(0), out.part[1] = part(1);
  return out;
#elif defined(CSCD_NEON)
  // A table of 64 bytes; each number takes four of them.
  uint8x16x4_t table;
  for (int i = 0; i < 4; ++i) table.val[i] = vreinterpretq_u8_f32(v.part[i]);
  const auto part = [&](int i) {
    std::uint32_t four;
    std::memcpy(&four, place.data() + 4 * i, sizeof four);
    const uint32x4_t lanes = vmovl_u16(vget_low_u16(vmovl_u8(vcreate_u8(four))));
    const uint32x4_t bytes = vaddq_u32(vmulq_n_u32(lanes, 0x04040404), vdupq_n_u32(0x03020100));
    return vreinterpretq_f32_u8(vqtbl4q_u8(table, vreinterpretq_u8_u32(bytes)));
  };
  Float16 out;
  out.part[0] = part(0), out.part[1] = part(1), out.part[2] = part(2), out.part[3] = part(3);
  return out;
#else
  // By way of memory: SSE2 moves only what a constant names, and WebAssembly permutes single bytes of one
  // register.
  float all[kLanes16];
  store(v, all);
  const auto part = [&](std::size_t i) {
    return RegisterOf<float>{all[place[i]], all[place[i + 1]], all[place[i + 2]], all[place[i + 3]]};
  };
  Float16 out;
  out.part[0] = part(0), out.part[1] = part(4), out.part[2] = part(8), out.part[3] = part(12);
  return out;
#endif
}

// Sixteen points, of which any sixteen can be taken by their places. `axis` holds the coordinates along x, y
// and z. A processor that permutes registers takes a coordinate at a time; another one keeps the points row
// by row in memory, and transposes what it loads.
class Points16 {
 public:
#if defined(__AVX2__) || defined(CSCD_NEON)
  explicit Points16(const Float16 (&axis)[3]) : axis_(axis) {}
  // Writes point place[l] to lane l of `out`.
  void take(const Places16& place, Float16 (&out)[3]) const {
    for (int i = 0; i < 3; ++i) out[i] = permuted(axis_[i], place);
  }

 private:
  const Float16 (&axis_)[3];
#else
  explicit Points16(const Float16 (&axis)[3]) {
    for (std::size_t r = 0; r < Float16::kRegisters; ++r) {
      const Float4 x = axis[0].part[r], y = axis[1].part[r], z = axis[2].part[r];
      const Float4 xy[] = {first_two(x, y), last_two(x, y)}, zz[] = {first_two(z, z), last_two(z, z)};
      for (std::size_t i = 0; i < 2; ++i) {
        row_[4 * r + 2 * i] = __builtin_shufflevector(xy[i], zz[i], 0, 1, 4, 5);
        row_[4 * r + 2 * i + 1] = __builtin_shufflevector(xy[i], zz[i], 2, 3, 6, 7);
      }
    }
  }
  // Writes point place[l] to lane l of `out`.
  void take(const Places16& place, Float16 (&out)[3]) const {
    for (std::size_t r = 0; r < Float16::kRegisters; ++r) {
      const auto row = [&](std::size_t i) { return row_[place[4 * r + i]]; };
      const Float4 a = row(0), b = row(1), c = row(2), d = row(3);
      const Float4 ab = first_two(a, b), cd = first_two(c, d);
      out[0].part[r] = __builtin_shufflevector(ab, cd, 0, 1, 4, 5);
      out[1].part[r] = __builtin_shufflevector(ab, cd, 2, 3, 6, 7);
      out[2].part[r] = __builtin_shufflevector(last_two(a, b), last_two(c, d), 0, 1, 4, 5);
    }
  }

 private:
  static Float4 first_two(Float4 a, Float4 b) {
    return __builtin_shufflevector(a, b, 0, 4, 1, 5);
  }
  static Float4 last_two(Float4 a, Float4 b) {
    return __builtin_shufflevector(a, b, 2, 6, 3, 7);
  }
  std::array<Float4, kLanes16> row_;
#endif
};

}  // namespace cscd
