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

}  // namespace cscd
