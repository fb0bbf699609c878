#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#ifdef __AVX512F__
#include <immintrin.h>
#endif

namespace cscd {

// Sixteen floats side by side: one AVX-512 register, or several smaller ones. What the vector types of gcc
// and clang lack stands here twice: one instruction where there is one, else a loop.
inline constexpr std::size_t kLanes16 = 16;
using Float16 = float __attribute__((vector_size(kLanes16 * sizeof(float))));
using Mask16 = std::uint16_t;  // one bit a lane
using Places16 = std::array<std::uint8_t, kLanes16>;

inline Float16 smaller(Float16 a, Float16 b) {
  return a < b ? a : b;
}
inline Float16 larger(Float16 a, Float16 b) {
  return a < b ? b : a;
}
inline Float16 absolute(Float16 a) {
  return larger(a, -a);
}

// Where a > b.
inline Mask16 above(Float16 a, Float16 b) {
#ifdef __AVX512F__
  return _mm512_cmp_ps_mask(a, b, _CMP_GT_OQ);
#else
  const auto lanes = a > b;
  Mask16 bits = 0;
  for (std::size_t l = 0; l < kLanes16; ++l) bits |= static_cast<Mask16>((lanes[l] & 1) << l);
  return bits;
#endif
}

// Lane l of the result is lane place[l] of v.
inline Float16 permuted(Float16 v, const Places16& place) {
#if defined __AVX512F__
  using Byte16 = std::uint8_t __attribute__((vector_size(kLanes16)));
  using Int16 = std::int32_t __attribute__((vector_size(kLanes16 * sizeof(std::int32_t))));
  Byte16 bytes;
  std::memcpy(&bytes, place.data(), sizeof bytes);
  const Int16 from = __builtin_convertvector(bytes, Int16);
#ifdef __clang__
  return _mm512_permutexvar_ps(reinterpret_cast<__m512i>(from), v);
#else
  return __builtin_shuffle(v, from);
#endif
#else
  Float16 out;
  for (std::size_t l = 0; l < kLanes16; ++l) out[l] = v[place[l]];
  return out;
#endif
}

// Halves exchanged.
inline Float16 swapped(Float16 v) {
  return __builtin_shufflevector(v, v, 8, 9, 10, 11, 12, 13, 14, 15, 0, 1, 2, 3, 4, 5, 6, 7);
}

// Halves the number of rows: neighbouring lanes of two rows become one row. A template, so that loops unroll.
template <std::size_t kRows>
inline void fold_rows(Float16* row) {
  for (std::size_t r = 0; r < kRows / 2; ++r) {
    const Float16 a = row[2 * r], b = row[2 * r + 1];
    row[r] =
        smaller(__builtin_shufflevector(a, b, 0, 2, 4, 6, 8, 10, 12, 14, 16, 18, 20, 22, 24, 26, 28, 30),
                __builtin_shufflevector(a, b, 1, 3, 5, 7, 9, 11, 13, 15, 17, 19, 21, 23, 25, 27, 29, 31));
  }
  if constexpr (kRows > 2) fold_rows<kRows / 2>(row);
}

// Lane r of the result is the smallest lane of row r.
inline Float16 smallest_of_rows(Float16 (&row)[kLanes16]) {
  fold_rows<kLanes16>(row);
  return row[0];
}

}  // namespace cscd
