#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>
#include <utility>
#if defined(__SSE2__)
#include <immintrin.h>
#elif defined(__ARM_NEON) && defined(__aarch64__)
#include <arm_neon.h>
#define CSCD_NEON
#elif defined(__wasm_simd128__)
#include <wasm_simd128.h>
#endif

#include "core/geometry/simd_registers.h"

// Numbers side by side in 64 bytes: one register of AVX-512, two of AVX2, or four of 16 bytes on any other
// processor. Each number stands in a *lane*, and v[l] is lane l. Operators work lane by lane, also with one
// number for all lanes. Comparisons give -1 for true and 0 for false in each lane. Functions for which vector
// types have no operator stand here and in simd_registers.h. Those that are one instruction on a register are
// written for one register, and by_register() calls them for each.
namespace cscd {

#if defined(__AVX512F__)
inline constexpr std::size_t kRegisterBytes = 64;
#elif defined(__AVX2__)
inline constexpr std::size_t kRegisterBytes = 32;
#else
inline constexpr std::size_t kRegisterBytes = 16;
#endif
template <class Number>
using RegisterOf = VectorOf<Number, kRegisterBytes>;

namespace internal {
template <class Number, std::size_t kBytes>
struct Filling {
  using Type = Registers<Number, kBytes, kRegisterBytes>;
};
template <class Number, std::size_t kBytes>
requires(kBytes <= kRegisterBytes) struct Filling<Number, kBytes> {
  using Type = VectorOf<Number, kBytes>;
};
}  // namespace internal

// Numbers that fill so many bytes: one vector, or several registers.
template <class Number, std::size_t kBytes>
using FillingOf = typename internal::Filling<Number, kBytes>::Type;
template <class Number>
using LanesOf = FillingOf<Number, 64>;
template <class Number>
using HalfOf = FillingOf<Number, 32>;

template <class T>
concept SeveralRegisters = requires {
  typename T::Register;
};

// Register i of the result is what the operation makes of register i of each operand.
template <class Result, class Operation, class... Operands>
[[gnu::always_inline]] inline Result by_register(const Operation& operation, const Operands&... v) {
  if constexpr (SeveralRegisters<Result>)
    return Result::each(operation, v...);
  else
    return operation(v...);
}

// Returns a where the comparison is true, else b. Lanes and single numbers both work.
template <class Mask, class Number>
Number select(const Mask& where, const Number& a, const Number& b) {
  return by_register<Number>([](auto w, auto x, auto y) { return w ? x : y; }, where, a, b);
}

// Return the smaller, or larger, of a and b, for lanes and for single numbers. They do not call select(),
// because compilers recognise a minimum only where the comparison and the choice stand together.
template <class Number>
Number smaller(const Number& a, const Number& b) {
  return by_register<Number>([](auto x, auto y) { return x < y ? x : y; }, a, b);
}
template <class Number>
Number larger(const Number& a, const Number& b) {
  return by_register<Number>([](auto x, auto y) { return x < y ? y : x; }, a, b);
}

#ifdef __AVX512F__
// For registers of 64 bytes gcc does not recognise a minimum even in that form. The intrinsics take masks of
// ones, because gcc 12 warns about the forms without a mask (GCC bug 105593).
inline LanesOf<float> smaller(LanesOf<float> a, LanesOf<float> b) {
  return _mm512_maskz_min_ps(0xffff, a, b);
}
inline LanesOf<float> larger(LanesOf<float> a, LanesOf<float> b) {
  return _mm512_maskz_max_ps(0xffff, b, a);
}
inline LanesOf<double> smaller(LanesOf<double> a, LanesOf<double> b) {
  return _mm512_maskz_min_pd(0xff, a, b);
}
inline LanesOf<double> larger(LanesOf<double> a, LanesOf<double> b) {
  return _mm512_maskz_max_pd(0xff, b, a);
}
#endif

// Returns the numbers that stand at `from` in memory, register by register: gcc copies what fills several
// registers through the stack where memcpy() reads all of it at once.
template <class Lanes, class Number>
Lanes loaded(const Number* from) {
  if constexpr (SeveralRegisters<Lanes>) {
    const auto all = [&]<std::size_t... i>(std::index_sequence<i...>) {
      Lanes out;
      (std::memcpy(&out.part[i], from + i * Lanes::kPerRegister, sizeof out.part[i]), ...);
      return out;
    };
    return all(std::make_index_sequence<Lanes::kRegisters>{});
  } else {
    Lanes out;
    std::memcpy(&out, from, sizeof out);
    return out;
  }
}
// Writes all numbers to memory, in the same way.
template <class Lanes, class Number>
void store(const Lanes& v, Number* to) {
  if constexpr (SeveralRegisters<Lanes>) {
    const auto all = [&]<std::size_t... i>(std::index_sequence<i...>) {
      (std::memcpy(to + i * Lanes::kPerRegister, &v.part[i], sizeof v.part[i]), ...);
    };
    all(std::make_index_sequence<Lanes::kRegisters>{});
  } else {
    std::memcpy(to, &v, sizeof v);
  }
}

// Lane l of the result is lane kFrom[l] of a and b, where b's lanes are numbered after those of a.
template <int... kFrom, class Vector>
Vector shuffled(Vector a, Vector b) {
  return __builtin_shufflevector(a, b, kFrom...);
}

// Joins two vectors to one of twice the size.
template <class To, class Half>
To joined(Half low, Half high) {
#ifdef __AVX512F__
  // gcc would compile a shuffle to an instruction on two registers; this one may take `high` from memory.
  if constexpr (sizeof(To) == sizeof(__m512d))
    return reinterpret_cast<To>(_mm512_maskz_insertf64x4(
        0xff, _mm512_castpd256_pd512(reinterpret_cast<__m256d>(low)), reinterpret_cast<__m256d>(high), 1));
#endif
  if constexpr (SeveralRegisters<Half>) {
    To out;
    const auto fill = [&]<std::size_t... i>(std::index_sequence<i...>) {
      ((out.part[i] = low.part[i], out.part[Half::kRegisters + i] = high.part[i]), ...);
    };
    fill(std::make_index_sequence<Half::kRegisters>{});
    return out;
  } else if constexpr (SeveralRegisters<To>) {
    To out;
    out.part[0] = low, out.part[1] = high;
    return out;
  } else {
    const auto all = [&]<int... kLane>(std::integer_sequence<int, kLane...>) {
      return To(__builtin_shufflevector(low, high, kLane...));
    };
    return all(std::make_integer_sequence<int, sizeof(To) / sizeof(low[0])>{});
  }
}

#ifdef CSCD_NEON
// Returns the first bit of each byte.
inline std::uint16_t bits_of_bytes(uint8x16_t bytes) {
  const uint8x8_t place = vcreate_u8(0x8040201008040201U);
  const uint8x16_t bits = vandq_u8(bytes, vcombine_u8(place, place));
  return static_cast<std::uint16_t>(vaddv_u8(vget_low_u8(bits)) | vaddv_u8(vget_high_u8(bits)) << 8);
}
#endif

// Returns the first half of the numbers, or the second half.
template <class Half, int kHalf, class Whole>
Half half_of(const Whole& v) {
  if constexpr (SeveralRegisters<Half>) {
    const auto all = [&]<std::size_t... i>(std::index_sequence<i...>) {
      Half out;
      ((out.part[i] = v.part[kHalf * Half::kRegisters + i]), ...);
      return out;
    };
    return all(std::make_index_sequence<Half::kRegisters>{});
  } else if constexpr (SeveralRegisters<Whole>) {
    return v.part[kHalf];
  } else {
    Half halves[2];
    std::memcpy(&halves, &v, sizeof v);
    return halves[kHalf];
  }
}

namespace internal {
template <class T>
struct RegisterIn {
  using Type = T;
};
template <SeveralRegisters T>
struct RegisterIn<T> {
  using Type = typename T::Register;
};
}  // namespace internal

// Returns the same bits as another type.
template <class To, class From>
To bits_as(const From& v) {
  return by_register<To>([](auto r) { return reinterpret_cast<typename internal::RegisterIn<To>::Type>(r); },
                         v);
}

namespace internal {

// Returns the numbers of two registers as numbers of half their size in one.
template <class To, class From>
[[gnu::always_inline]] inline To narrowed(From a, From b) {
#if defined(__SSE2__) && !defined(__AVX2__)
  if constexpr (std::is_same_v<To, VectorOf<float, 16>>)
    return _mm_movelh_ps(_mm_cvtpd_ps(a), _mm_cvtpd_ps(b));
#elif defined(CSCD_NEON)
  if constexpr (std::is_same_v<To, VectorOf<float, 16>>) return vcvt_high_f32_f64(vcvt_f32_f64(a), b);
#elif defined(__wasm_simd128__)
  if constexpr (std::is_same_v<To, VectorOf<float, 16>>) {
    const auto two = [](From v) { return wasm_f32x4_demote_f64x2_zero(reinterpret_cast<v128_t>(v)); };
    return reinterpret_cast<To>(wasm_i64x2_shuffle(two(a), two(b), 0, 2));
  }
#endif
  using Half = VectorOf<std::remove_cvref_t<decltype(To{}[0])>, sizeof(To) / 2>;
  return joined<To>(__builtin_convertvector(a, Half), __builtin_convertvector(b, Half));
}

// Returns the first half of a register's numbers, or the second half, as numbers of twice their size.
template <class To, int kHalf, class From>
[[gnu::always_inline]] inline To widened(From v) {
#if defined(__SSE2__) && !defined(__AVX2__)
  if constexpr (std::is_same_v<From, VectorOf<float, 16>>)
    return _mm_cvtps_pd(kHalf == 0 ? v : _mm_movehl_ps(v, v));
#elif defined(CSCD_NEON)
  if constexpr (std::is_same_v<From, VectorOf<float, 16>>)
    return kHalf == 0 ? vcvt_f64_f32(vget_low_f32(v)) : vcvt_high_f64_f32(v);
#elif defined(__wasm_simd128__)
  if constexpr (std::is_same_v<From, VectorOf<float, 16>>) {
    const auto all = reinterpret_cast<v128_t>(v);
    return reinterpret_cast<To>(
        wasm_f64x2_promote_low_f32x4(kHalf == 0 ? all : wasm_i64x2_shuffle(all, all, 1, 0)));
  }
#endif
  using Half = VectorOf<std::remove_cvref_t<decltype(v[0])>, sizeof(From) / 2>;
  return __builtin_convertvector((half_of<Half, kHalf>(v)), To);
}

}  // namespace internal

// Returns the same numbers as another type, rounded if need be. Where its numbers have another size, it has
// as many of them.
template <class To, class From>
To converted(const From& v) {
  using Register = typename internal::RegisterIn<To>::Type;
  if constexpr (sizeof(To) == sizeof(From)) {
    return by_register<To>([](auto r) { return __builtin_convertvector(r, Register); }, v);
  } else if constexpr (!SeveralRegisters<To> && !SeveralRegisters<From>) {
    return __builtin_convertvector(v, To);
  } else if constexpr (!SeveralRegisters<To>) {
    return internal::narrowed<To>(v.part[0], v.part[1]);
  } else {
    const auto all = [&]<std::size_t... i>(std::index_sequence<i...>) {
      To out;
      if constexpr (sizeof(To) < sizeof(From))
        ((out.part[i] = internal::narrowed<Register>(v.part[2 * i], v.part[2 * i + 1])), ...);
      else if constexpr (SeveralRegisters<From>)
        ((out.part[i] = internal::widened<Register, i % 2>(v.part[i / 2])), ...);
      else
        ((out.part[i] = internal::widened<Register, i>(v)), ...);
      return out;
    };
    return all(std::make_index_sequence<To::kRegisters>{});
  }
}

}  // namespace cscd
