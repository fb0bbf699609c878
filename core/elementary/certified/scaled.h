#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

// Doubles as integers times powers of two, from which the stages of integers start.
namespace cscd::integer {

// The double mantissa * 2^exponent.
struct Scaled {
  std::int64_t mantissa = 0;  // odd, or zero
  int exponent = 0;
};
inline Scaled scaled(double x) {
  if (x == 0) return {};
  int exponent = 0;
  const auto mantissa = static_cast<std::int64_t>(std::ldexp(std::frexp(x, &exponent), 53));
  const int spare = std::countr_zero(static_cast<std::uint64_t>(mantissa));
  return {mantissa >> spare, exponent - 53 + spare};  // exact: the low bits are zero
}

// The places between the lowest and the highest bit of some numbers.
class BitSpan {
 public:
  void add(const Scaled& x) {
    if (x.mantissa == 0) return;
    const auto size = static_cast<std::uint64_t>(x.mantissa < 0 ? -x.mantissa : x.mantissa);
    lowest_ = x.exponent < lowest_ ? x.exponent : lowest_;
    const int above = x.exponent + static_cast<int>(std::bit_width(size));
    highest_ = above > highest_ ? above : highest_;
  }
  int lowest() const { return lowest_; }
  int bits() const { return highest_ > lowest_ ? highest_ - lowest_ : 0; }

 private:
  int lowest_ = 1 << 20, highest_ = -(1 << 20);
};

}  // namespace cscd::integer
