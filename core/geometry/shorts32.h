#pragma once

#include <cstdint>
#ifdef __AVX2__
#include <immintrin.h>
#endif

#include "core/geometry/lanes16.h"

namespace cscd {

// Thirty-two 16-bit integers side by side: sixteen pairs. What the vector types lack stands here twice, as in
// lanes16.h.
using Short32 = LanesOf<std::int16_t>;
using Mask32 = std::uint32_t;

// Where a > b.
inline Mask32 above(Short32 a, Short32 b) {
#ifdef __AVX512BW__
  return _mm512_cmpgt_epi16_mask(reinterpret_cast<__m512i>(a), reinterpret_cast<__m512i>(b));
#elif defined(__AVX2__) && !defined(__AVX512F__)
  const auto lanes = a > b;
  // Bytes of quarters of both halves by turns.
  const __m256i bytes =
      _mm256_packs_epi16(reinterpret_cast<__m256i>(lanes.low), reinterpret_cast<__m256i>(lanes.high));
  return static_cast<Mask32>(_mm256_movemask_epi8(_mm256_permute4x64_epi64(bytes, 0b11011000)));
#else
  const auto lanes = a > b;
  Mask32 bits = 0;
  for (int l = 0; l < 32; ++l) bits |= static_cast<Mask32>(lanes[l] & 1) << l;
  return bits;
#endif
}

// Pair l holds scale a[l] and scale b[l], both rounded to the nearest integer, which 16 bits must hold.
inline Short32 rounded_pairs(Float16 a, Float16 b, float scale) {
  // Floats of this size are integers, and their last 16 bits are those of the integer.
  constexpr float kShift = 0x1.8p23F;
  const auto shifted = [&](Float16 v) {
    return bits_as<Int16>(product_plus(v, all_lanes(scale), all_lanes(kShift)));
  };
  const Int16 low = shifted(a), high = shifted(b);
  return bits_as<Short32>((low & 0xffff) | (high << 16));
}

// The larger and the smaller halves of the pairs exchanged: pairs 8 to 15 before 0 to 7.
inline Short32 swapped(Short32 v) {
  const auto pairs = bits_as<Int16>(v);
  return bits_as<Short32>(shuffled<8, 9, 10, 11, 12, 13, 14, 15, 0, 1, 2, 3, 4, 5, 6, 7>(pairs, pairs));
}

// Of eight rows at most 32767 in size: pair r of the result is the smallest pair of row r, pair 8 + r the
// smallest of its negative, each half by itself.
inline Short32 smallest_pairs_of_rows(const Short32 (&row)[8]) {
  // Neighbouring pairs of two rows within quarters, twice; then the quarters themselves, twice.
  const auto take = [](Short32 a, Short32 b, const auto& shuffle) {
    return bits_as<Short32>(shuffle(bits_as<Int16>(a), bits_as<Int16>(b)));
  };
  const auto even = [](Int16 a, Int16 b) {
    return shuffled<0, 2, 16, 18, 4, 6, 20, 22, 8, 10, 24, 26, 12, 14, 28, 30>(a, b);
  };
  const auto odd = [](Int16 a, Int16 b) {
    return shuffled<1, 3, 17, 19, 5, 7, 21, 23, 9, 11, 25, 27, 13, 15, 29, 31>(a, b);
  };
  const auto even_quarters = [](Int16 a, Int16 b) {
    return shuffled<0, 1, 2, 3, 8, 9, 10, 11, 16, 17, 18, 19, 24, 25, 26, 27>(a, b);
  };
  const auto odd_quarters = [](Int16 a, Int16 b) {
    return shuffled<4, 5, 6, 7, 12, 13, 14, 15, 20, 21, 22, 23, 28, 29, 30, 31>(a, b);
  };
  Short32 of[8];  // rows, then their negatives
#pragma GCC unroll 4
  for (int r = 0; r < 4; ++r) {
    const Short32 a = take(row[2 * r], row[2 * r + 1], even), b = take(row[2 * r], row[2 * r + 1], odd);
    of[r] = smaller(a, b);
    of[4 + r] = -larger(a, b);
  }
#pragma GCC unroll 4
  for (int r = 0; r < 4; ++r)
    of[r] = smaller(take(of[2 * r], of[2 * r + 1], even), take(of[2 * r], of[2 * r + 1], odd));
#pragma GCC unroll 2
  for (int r = 0; r < 2; ++r)
    of[r] =
        smaller(take(of[2 * r], of[2 * r + 1], even_quarters), take(of[2 * r], of[2 * r + 1], odd_quarters));
  return smaller(take(of[0], of[1], even_quarters), take(of[0], of[1], odd_quarters));
}

}  // namespace cscd
