#pragma once

#include <cstdint>
#include <cstring>
#include <utility>

#include "core/geometry/simd_floats.h"

namespace cscd {

// Thirty-two 16-bit integers side by side. They form sixteen *pairs*: pair l holds numbers 2 l and 2 l + 1.
// Operations that vector types lack are written several times, as in simd_floats.h.
using Short32 = LanesOf<std::int16_t>;
using Mask32 = std::uint32_t;

// Returns the lanes in which a > b.
inline Mask32 above(Short32 a, Short32 b) {
#if defined(__AVX512BW__)
  return _mm512_cmpgt_epi16_mask(reinterpret_cast<__m512i>(a), reinterpret_cast<__m512i>(b));
#elif defined(__AVX2__) && !defined(__AVX512F__)
  const auto lanes = a > b;
  // The instruction packs quarters of both registers in turn; the permutation puts
  // them into the order of the lanes.
  const __m256i bytes =
      _mm256_packs_epi16(reinterpret_cast<__m256i>(lanes.part[0]), reinterpret_cast<__m256i>(lanes.part[1]));
  return static_cast<Mask32>(_mm256_movemask_epi8(_mm256_permute4x64_epi64(bytes, 0b11011000)));
#elif defined(__SSE2__) && !defined(__AVX512F__)
  const auto lanes = a > b;
  const auto bits = [&](int i) {
    return static_cast<Mask32>(_mm_movemask_epi8(_mm_packs_epi16(
        reinterpret_cast<__m128i>(lanes.part[i]), reinterpret_cast<__m128i>(lanes.part[i + 1]))));
  };
  return bits(0) | bits(2) << 16;
#elif defined(CSCD_NEON)
  const auto lanes = a > b;
  const auto bits = [&](int i) {
    return static_cast<Mask32>(
        bits_of_bytes(vreinterpretq_u8_s8(vmovn_high_s16(vmovn_s16(lanes.part[i]), lanes.part[i + 1]))));
  };
  return bits(0) | bits(2) << 16;
#elif defined(__wasm_simd128__)
  const auto lanes = a > b;
  const auto bits = [&](int i) {
    return static_cast<Mask32>(wasm_i8x16_bitmask(wasm_i8x16_narrow_i16x8(
        reinterpret_cast<v128_t>(lanes.part[i]), reinterpret_cast<v128_t>(lanes.part[i + 1]))));
  };
  return bits(0) | bits(2) << 16;
#else
  const auto lanes = a > b;
  Mask32 bits = 0;
  for (int l = 0; l < 32; ++l) bits |= static_cast<Mask32>(lanes[l] & 1) << l;
  return bits;
#endif
}

// Pair l of the result holds scale * a[l] and scale * b[l], both rounded to the nearest
// integer, which must fit into 16 bits.
inline Short32 rounded_pairs(Float16 a, Float16 b, float scale) {
  // A float near 1.5 * 2^23 is an integer, and its last 16 bits are those of the integer added to 1.5 * 2^23.
  constexpr float kShift = 0x1.8p23F;
  const auto shifted = [&](Float16 v) {
    return bits_as<Int16>(product_plus(v, all_lanes(scale), all_lanes(kShift)));
  };
  const Int16 low = shifted(a), high = shifted(b);
  return bits_as<Short32>((low & 0xffff) | (high << 16));
}

// Returns one pair of v in all places.
inline Short32 all_pairs(const Short32& v, std::size_t pair) {
  std::int32_t number;
  std::memcpy(&number, reinterpret_cast<const char*>(&v) + pair * sizeof number, sizeof number);
  return bits_as<Short32>(Int16{} + number);
}

// Pair l of the result is pair place[l] of v.
inline Short32 permuted_pairs(Short32 v, const Places16& place) {
  return bits_as<Short32>(permuted(bits_as<Float16>(v), place));  // permuted() moves bits, whatever they mean
}

// Exchanges the two numbers of each pair.
inline Short32 turned_pairs(Short32 v) {
  const auto pairs = bits_as<Int16>(v);
  return bits_as<Short32>((pairs << 16) | ((pairs >> 16) & 0xffff));
}

// Keeps the bits of the first number of each pair.
inline Mask16 first_of_pairs(Mask32 bits) {
#ifdef __BMI2__
  return static_cast<Mask16>(_pext_u32(bits, 0x55555555U));
#else
  bits &= 0x55555555U;
  bits = (bits | bits >> 1) & 0x33333333U;
  bits = (bits | bits >> 2) & 0x0f0f0f0fU;
  bits = (bits | bits >> 4) & 0x00ff00ffU;
  return static_cast<Mask16>(bits | bits >> 8);
#endif
}

// Exchanges the two halves of v: pairs 8 to 15 come before pairs 0 to 7.
inline Short32 swapped(Short32 v) {
  const auto pairs = bits_as<Int16>(v);
  return bits_as<Short32>(shuffled<8, 9, 10, 11, 12, 13, 14, 15, 0, 1, 2, 3, 4, 5, 6, 7>(pairs, pairs));
}

// One step of a reduction over two rows. Where bit kBit of l is 0, pair l of `own` is pair l of a, and where
// the bit is 1, pair l of b. Pair l of `other` comes from the same row, from the pair whose number differs
// from l in that bit. So the smaller of `own` and `other` holds the minimum of two pairs of one row. Shuffles
// alone would need two of them to bring these pairs together; this form needs one shuffle and a blend.
struct Neighbours {
  Short32 own, other;
};
template <int kBit>
inline Neighbours neighbours(Short32 a, Short32 b) {
  const auto all = [&]<int... kPair>(std::integer_sequence<int, kPair...>) {
    const auto first = bits_as<Int16>(a), second = bits_as<Int16>(b);
    return Neighbours{
        bits_as<Short32>(shuffled<((kPair & kBit ? 16 : 0) + kPair)...>(first, second)),
        bits_as<Short32>(shuffled<((kPair & kBit ? 16 : 0) + (kPair ^ kBit))...>(first, second))};
  };
  return all(std::make_integer_sequence<int, 16>{});
}

// Takes eight rows of numbers at most 32767 in size. Pair r of the result is the smallest pair of row r, and
// pair 8 + r the smallest of its negative, each half by itself.
inline Short32 smallest_pairs_of_rows(const Short32 (&row)[8]) {
  Short32 of[8];  // each step turns a bit of row numbers into a bit of pair numbers; the last marks negatives
#pragma GCC unroll 4
  for (int r = 0; r < 4; ++r) {
    const auto [own, other] = neighbours<1>(row[2 * r], row[2 * r + 1]);
    of[r] = smaller(own, other);
    of[4 + r] = -larger(own, other);
  }
  const auto smallest = [](const Neighbours& both) { return smaller(both.own, both.other); };
#pragma GCC unroll 4
  for (int r = 0; r < 4; ++r) of[r] = smallest(neighbours<2>(of[2 * r], of[2 * r + 1]));
#pragma GCC unroll 2
  for (int r = 0; r < 2; ++r) of[r] = smallest(neighbours<4>(of[2 * r], of[2 * r + 1]));
  return smallest(neighbours<8>(of[0], of[1]));
}

}  // namespace cscd
