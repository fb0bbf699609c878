#pragma once

#include <type_traits>
#include <utility>
#ifdef __AVX512F__
#include <immintrin.h>
#endif

#include "core/geometry/simd_halves.h"

// Numbers side by side in 64 bytes: one AVX-512 register, or two halves. Each number stands in a *lane*, and
// v[l] is lane l. Operators work lane by lane, also with one number for all lanes. Comparisons give -1 for
// true and 0 for false in each lane. Functions for which vector types have no operator, or none that both
// forms share, stand here and in simd_halves.h.
namespace cscd {

#ifdef __AVX512F__
template <class Number>
using LanesOf = VectorOf<Number, 64>;
#else
template <class Number>
using LanesOf = Halves<Number>;
#endif
template <class Number>
using HalfOf = VectorOf<Number, 32>;

template <class T>
concept InHalves = requires {
  typename T::Half;
};

// Returns a where the comparison is true, else b. Lanes and single numbers both work.
template <class Mask, class Number>
Number select(Mask where, Number a, Number b) {
  return where ? a : b;
}

// Return the smaller, or larger, of a and b, for lanes and for single numbers. They do not call select(),
// because compilers recognise a minimum only where the comparison and the choice stand together.
template <class Number>
Number smaller(Number a, Number b) {
  return a < b ? a : b;
}
template <class Number>
Number larger(Number a, Number b) {
  return a < b ? b : a;
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
  if constexpr (InHalves<To>) {
    return {low, high};
  } else {
    const auto all = [&]<int... kLane>(std::integer_sequence<int, kLane...>) {
      return To(__builtin_shufflevector(low, high, kLane...));
    };
    return all(std::make_integer_sequence<int, sizeof(To) / sizeof(low[0])>{});
  }
}

// Returns the same bits as another type.
template <class To, class From>
To bits_as(From v) {
  if constexpr (InHalves<From>) {
    using Half = typename To::Half;
    return {reinterpret_cast<Half>(v.low), reinterpret_cast<Half>(v.high)};
  } else {
    return reinterpret_cast<To>(v);
  }
}

// Returns the same numbers as another type, rounded if need be. Either type may
// be one that fills half a vector.
template <class To, class From>
To converted(From v) {
  if constexpr (InHalves<From> && InHalves<To>) {
    using Half = typename To::Half;
    return {__builtin_convertvector(v.low, Half), __builtin_convertvector(v.high, Half)};
  } else if constexpr (InHalves<From>) {
    using Quarter = VectorOf<std::remove_cvref_t<decltype(To{}[0])>, sizeof(To) / 2>;
    return joined<To>(__builtin_convertvector(v.low, Quarter), __builtin_convertvector(v.high, Quarter));
  } else if constexpr (InHalves<To>) {
    using Quarter = VectorOf<std::remove_cvref_t<decltype(v[0])>, sizeof(From) / 2>;
    Quarter quarter[2];
    __builtin_memcpy(quarter, &v, sizeof v);
    using Half = typename To::Half;
    return {__builtin_convertvector(quarter[0], Half), __builtin_convertvector(quarter[1], Half)};
  } else {
    return __builtin_convertvector(v, To);
  }
}

}  // namespace cscd
