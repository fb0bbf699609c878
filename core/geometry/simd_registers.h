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
template <class Number>
using SignedOf = std::conditional_t<sizeof(Number) == 8, std::int64_t,
                                    std::conditional_t<sizeof(Number) == 4, std::int32_t, std::int16_t>>;
}  // namespace internal
template <class Number, std::size_t kBytes>
using VectorOf = typename internal::Vector<Number, kBytes>::Type;

// Numbers side by side in several registers of kEach bytes, for processors without a register of kBytes.
// (gcc keeps a vector type that fits no register in memory, and compares, selects and shuffles it number by
// number.) The class has the operators of a vector type; functions for which vector types have no operator
// stand in simd_register.h.
template <class Number, std::size_t kBytes, std::size_t kEach>
struct alignas(kBytes) Registers {
  using Register = VectorOf<Number, kEach>;
  using Comparison = Registers<internal::SignedOf<Number>, kBytes, kEach>;
  static constexpr std::size_t kCount = kBytes / sizeof(Number), kPerRegister = kEach / sizeof(Number),
                               kRegisters = kBytes / kEach;

  Register part[kRegisters];

  Registers() = default;
  Registers(Number all)  // a zero keeps its sign; 0 + -0 would be 0
      : Registers(each([all]() { return all - Register{}; })) {}
  // Takes the first numbers; the remaining ones are 0.
  template <class... Numbers>
  requires(sizeof...(Numbers) > 1 && (std::is_arithmetic_v<Numbers> && ...)) constexpr Registers(Numbers... n)
      : Registers(std::array<Number, kCount>{static_cast<Number>(n)...},
                  std::make_index_sequence<kRegisters>{}) {}

  // Access to single numbers. Compilers allow a vector to be read and written as an array of its numbers.
  Number& operator[](std::size_t lane) { return reinterpret_cast<Number*>(this)[lane]; }
  Number operator[](std::size_t lane) const { return reinterpret_cast<const Number*>(this)[lane]; }

  // Register i of the result is what the operation makes of register i of each operand.
  template <class Operation, class... Operands>
  [[gnu::always_inline]] static Registers each(const Operation& operation, const Operands&... v) {
    const auto one = [&]<std::size_t i>(std::index_sequence<i>) __attribute__((always_inline)) {
      return operation(v.part[i]...);
    };
    const auto all = [&]<std::size_t... i>(std::index_sequence<i...>) __attribute__((always_inline)) {
      Registers out;
      ((out.part[i] = one(std::index_sequence<i>{})), ...);
      return out;
    };
    return all(std::make_index_sequence<kRegisters>{});
  }

  friend Registers operator-(const Registers& a) {
    return each([](Register x) { return -x; }, a);
  }
  friend Registers operator~(const Registers& a) {
    return each([](Register x) { return ~x; }, a);
  }
  friend Registers operator<<(const Registers& a, int bits) {
    return each([bits](Register x) { return x << bits; }, a);
  }
  friend Registers operator>>(const Registers& a, int bits) {
    return each([bits](Register x) { return x >> bits; }, a);
  }
  friend Registers operator+(const Registers& a, const Registers& b) {
    return each([](Register x, Register y) { return x + y; }, a, b);
  }
  friend Registers operator-(const Registers& a, const Registers& b) {
    return each([](Register x, Register y) { return x - y; }, a, b);
  }
  friend Registers operator*(const Registers& a, const Registers& b) {
    return each([](Register x, Register y) { return x * y; }, a, b);
  }
  friend Registers operator/(const Registers& a, const Registers& b) {
    return each([](Register x, Register y) { return x / y; }, a, b);
  }
  friend Registers operator&(const Registers& a, const Registers& b) {
    return each([](Register x, Register y) { return x & y; }, a, b);
  }
  friend Registers operator|(const Registers& a, const Registers& b) {
    return each([](Register x, Register y) { return x | y; }, a, b);
  }
  friend Registers& operator+=(Registers& a, const Registers& b) { return a = a + b; }
  friend Registers& operator-=(Registers& a, const Registers& b) { return a = a - b; }
  friend Registers& operator*=(Registers& a, const Registers& b) { return a = a * b; }
  friend Registers& operator&=(Registers& a, const Registers& b) { return a = a & b; }
  friend Registers& operator|=(Registers& a, const Registers& b) { return a = a | b; }
  friend Comparison operator==(const Registers& a, const Registers& b) {
    return Comparison::each([](Register x, Register y) { return x == y; }, a, b);
  }
  friend Comparison operator!=(const Registers& a, const Registers& b) {
    return Comparison::each([](Register x, Register y) { return x != y; }, a, b);
  }
  friend Comparison operator<(const Registers& a, const Registers& b) {
    return Comparison::each([](Register x, Register y) { return x < y; }, a, b);
  }
  friend Comparison operator>(const Registers& a, const Registers& b) {
    return Comparison::each([](Register x, Register y) { return x > y; }, a, b);
  }
  friend Comparison operator<=(const Registers& a, const Registers& b) {
    return Comparison::each([](Register x, Register y) { return x <= y; }, a, b);
  }
  friend Comparison operator>=(const Registers& a, const Registers& b) {
    return Comparison::each([](Register x, Register y) { return x >= y; }, a, b);
  }

 private:
  template <std::size_t... kLane>
  static constexpr Register register_of(const std::array<Number, kCount>& n, std::size_t first,
                                        std::index_sequence<kLane...>) {
    return Register{n[first + kLane]...};
  }
  template <std::size_t... i>
  constexpr Registers(const std::array<Number, kCount>& n, std::index_sequence<i...>)
      : part{register_of(n, kPerRegister * i, std::make_index_sequence<kPerRegister>{})...} {}
};

namespace internal {

// The registers that the lanes of one register come from, each once, in the order of the lanes.
template <std::size_t kLanes>
struct ShuffleSources {
  std::array<int, kLanes> at{};
  int count = 0;

  constexpr explicit ShuffleSources(const std::array<int, kLanes>& from) {
    for (const int lane : from)
      if (place_of(lane) == count) at[static_cast<std::size_t>(count++)] = lane / static_cast<int>(kLanes);
  }
  // Returns which of them holds a lane; their count if none does.
  constexpr int place_of(int lane) const {
    int place = 0;
    while (place < count && at[static_cast<std::size_t>(place)] != lane / static_cast<int>(kLanes)) ++place;
    return place;
  }
};

// Returns one register whose lane l is lane kFrom[l] of all registers in `source`. One shuffle suffices if
// the lanes come from at most two registers. Otherwise two are shuffled, then what is left, and then both.
template <std::array kFrom, std::size_t kSources, class Register, int... kLane>
[[gnu::always_inline]] inline Register shuffled_register(const Register (&source)[kSources],
                                                         std::integer_sequence<int, kLane...>) {
  constexpr int kCount = sizeof...(kLane);
  constexpr ShuffleSources kFound(kFrom);
  static_assert(kFound.count <= 4, "one register comes from at most four");
  // Lanes that come from elsewhere may hold anything, which -1 says.
  const auto two = [&]<int kFirst>(std::integral_constant<int, kFirst>) __attribute__((always_inline)) {
    constexpr int kSecond = kFirst + 1 < kFound.count ? kFirst + 1 : kFirst;
    return Register(
        __builtin_shufflevector(source[kFound.at[kFirst]], source[kFound.at[kSecond]],
                                (kFound.place_of(kFrom[kLane]) == kFirst    ? kFrom[kLane] % kCount
                                 : kFound.place_of(kFrom[kLane]) == kSecond ? kFrom[kLane] % kCount + kCount
                                                                            : -1)...));
  };
  const Register first = two(std::integral_constant<int, 0>{});
  if constexpr (kFound.count <= 2) {
    return first;
  } else if constexpr (kFound.count == 3) {
    return __builtin_shufflevector(
        first, source[kFound.at[2]],
        (kFound.place_of(kFrom[kLane]) < 2 ? kLane : kFrom[kLane] % kCount + kCount)...);
  } else {
    return __builtin_shufflevector(first, two(std::integral_constant<int, 2>{}),
                                   (kFound.place_of(kFrom[kLane]) < 2 ? kLane : kLane + kCount)...);
  }
}

}  // namespace internal

// Lane l of the result is lane kFrom[l] of a and b, where b's lanes are numbered after those of a.
template <int... kFrom, class Number, std::size_t kBytes, std::size_t kEach>
Registers<Number, kBytes, kEach> shuffled(const Registers<Number, kBytes, kEach>& a,
                                          const Registers<Number, kBytes, kEach>& b) {
  using Lanes = Registers<Number, kBytes, kEach>;
  constexpr auto kPart = [](std::size_t number) {
    constexpr std::array kAll{kFrom...};
    std::array<int, Lanes::kPerRegister> out{};
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = kAll[number * out.size() + i];
    return out;
  };
  Lanes out;
  const auto fill = [&]<std::size_t... i>(std::index_sequence<i...>) __attribute__((always_inline)) {
    const typename Lanes::Register source[] = {a.part[i]..., b.part[i]...};
    ((out.part[i] = internal::shuffled_register<kPart(i)>(
          source, std::make_integer_sequence<int, static_cast<int>(Lanes::kPerRegister)>{})),
     ...);
  };
  fill(std::make_index_sequence<Lanes::kRegisters>{});
  return out;
}

}  // namespace cscd
