#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>

namespace cscd {

namespace internal {
template <class Number, std::size_t kBytes>
struct Vector {
  typedef Number Type __attribute__((vector_size(kBytes)));  // `using` would lose the attribute
};
}  // namespace internal
template <class Number, std::size_t kBytes>
using VectorOf = typename internal::Vector<Number, kBytes>::Type;

// Numbers in 64 bytes as two vectors of 32 bytes each, for processors without registers of 64 bytes.
// (gcc keeps a vector type that fits no register in memory, and compares, selects and shuffles it
// number by number.) The class has the operators of a vector type; functions for which vector types
// have no operator stand in simd_register.h.
template <class Number>
struct alignas(64) Halves {
  using Half = VectorOf<Number, 32>;
  using Comparison =
      Halves<std::conditional_t<sizeof(Number) == 8, std::int64_t,
                                std::conditional_t<sizeof(Number) == 4, std::int32_t, std::int16_t>>>;
  static constexpr int kCount = 64 / sizeof(Number);

  Half low, high;

  Halves() = default;
  Halves(Half low_half, Half high_half) : low(low_half), high(high_half) {}
  Halves(Number all) : low(all - Half{}), high(low) {}  // a zero keeps its sign; 0 + -0 would be 0
  // Takes the first numbers; the remaining ones are 0.
  template <class... Numbers>
  requires(sizeof...(Numbers) > 1 && (std::is_arithmetic_v<Numbers> && ...)) constexpr Halves(Numbers... n)
      : Halves(std::array<Number, kCount>{static_cast<Number>(n)...},
               std::make_index_sequence<kCount / 2>{}) {}

  // Access to single numbers. Compilers allow a vector to be read and written as an array of its numbers.
  Number& operator[](std::size_t lane) { return reinterpret_cast<Number*>(this)[lane]; }
  Number operator[](std::size_t lane) const { return reinterpret_cast<const Number*>(this)[lane]; }

  friend Halves operator-(Halves a) { return {-a.low, -a.high}; }
  friend Halves operator~(Halves a) { return {~a.low, ~a.high}; }
  friend Halves operator+(Halves a, Halves b) { return {a.low + b.low, a.high + b.high}; }
  friend Halves operator-(Halves a, Halves b) { return {a.low - b.low, a.high - b.high}; }
  friend Halves operator*(Halves a, Halves b) { return {a.low * b.low, a.high * b.high}; }
  friend Halves operator/(Halves a, Halves b) { return {a.low / b.low, a.high / b.high}; }
  friend Halves operator&(Halves a, Halves b) { return {a.low & b.low, a.high & b.high}; }
  friend Halves operator|(Halves a, Halves b) { return {a.low | b.low, a.high | b.high}; }
  friend Halves operator<<(Halves a, int bits) { return {a.low << bits, a.high << bits}; }
  friend Halves operator>>(Halves a, int bits) { return {a.low >> bits, a.high >> bits}; }
  friend Halves& operator+=(Halves& a, Halves b) { return a = a + b; }
  friend Halves& operator-=(Halves& a, Halves b) { return a = a - b; }
  friend Halves& operator*=(Halves& a, Halves b) { return a = a * b; }
  friend Halves& operator&=(Halves& a, Halves b) { return a = a & b; }
  friend Halves& operator|=(Halves& a, Halves b) { return a = a | b; }
  friend Comparison operator==(Halves a, Halves b) { return {a.low == b.low, a.high == b.high}; }
  friend Comparison operator!=(Halves a, Halves b) { return {a.low != b.low, a.high != b.high}; }
  friend Comparison operator<(Halves a, Halves b) { return {a.low < b.low, a.high < b.high}; }
  friend Comparison operator>(Halves a, Halves b) { return {a.low > b.low, a.high > b.high}; }
  friend Comparison operator<=(Halves a, Halves b) { return {a.low <= b.low, a.high <= b.high}; }
  friend Comparison operator>=(Halves a, Halves b) { return {a.low >= b.low, a.high >= b.high}; }

 private:
  template <std::size_t... kLane>
  constexpr Halves(const std::array<Number, kCount>& n, std::index_sequence<kLane...>)
      : low{n[kLane]...}, high{n[kCount / 2 + kLane]...} {}
};

namespace internal {

// Returns one half whose numbers come from four halves. kFrom[lane] counts the numbers of a, b, c and d in
// turn. One shuffle suffices if the numbers come from at most two of the halves. Otherwise a and b are
// shuffled, then c and d, and then both results.
template <std::array kFrom, class Half, int... kLane>
Half shuffled_half(Half a, Half b, Half c, Half d, std::integer_sequence<int, kLane...>) {
  constexpr int kCount = sizeof...(kLane);
  constexpr auto kSource = [](int lane) { return kFrom[static_cast<std::size_t>(lane)] / kCount; };
  constexpr int kOne = kSource(0), kOther = [&] {
    int other = kOne;
    ((other = kSource(kLane) != kOne ? kSource(kLane) : other), ...);
    return other;
  }();
  if constexpr (((kSource(kLane) == kOne || kSource(kLane) == kOther) && ...)) {
    const Half* const source[] = {&a, &b, &c, &d};
    return __builtin_shufflevector(*source[kOne], *source[kOther],
                                   (kFrom[kLane] % kCount + (kSource(kLane) == kOne ? 0 : kCount))...);
  } else {
    const Half first = __builtin_shufflevector(a, b, (kSource(kLane) < 2 ? kFrom[kLane] : 0)...);
    const Half second =
        __builtin_shufflevector(c, d, (kSource(kLane) < 2 ? 0 : kFrom[kLane] - 2 * kCount)...);
    return __builtin_shufflevector(first, second, (kSource(kLane) < 2 ? kLane : kCount + kLane)...);
  }
}

}  // namespace internal

// Lane l of the result is lane kFrom[l] of a and b, where b's lanes are numbered after those of a.
template <int... kFrom, class Number>
Halves<Number> shuffled(Halves<Number> a, Halves<Number> b) {
  constexpr std::size_t kCount = sizeof...(kFrom) / 2;
  constexpr auto part = [](std::size_t first) {
    constexpr std::array kAll{kFrom...};
    std::array<int, kCount> out{};
    for (std::size_t i = 0; i < kCount; ++i) out[i] = kAll[first + i];
    return out;
  };
  constexpr std::make_integer_sequence<int, kCount> kLanes{};
  return {internal::shuffled_half<part(0)>(a.low, a.high, b.low, b.high, kLanes),
          internal::shuffled_half<part(kCount)>(a.low, a.high, b.low, b.high, kLanes)};
}

// Lane by lane: a where the comparison is true, else b.
template <class Number>
Halves<Number> select(typename Halves<Number>::Comparison where, Halves<Number> a, Halves<Number> b) {
  return {where.low ? a.low : b.low, where.high ? a.high : b.high};
}

template <class Number>
Halves<Number> smaller(Halves<Number> a, Halves<Number> b) {
  return {a.low < b.low ? a.low : b.low, a.high < b.high ? a.high : b.high};
}
template <class Number>
Halves<Number> larger(Halves<Number> a, Halves<Number> b) {
  return {a.low < b.low ? b.low : a.low, a.high < b.high ? b.high : a.high};
}

}  // namespace cscd
