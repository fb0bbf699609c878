#pragma once

#include <cmath>

#include "core/base/rounding.h"
#include "core/elementary/certified/contact_time.h"

// Numbers that know how far they are off. Sums, differences and products bound their own roundings, so a
// formula that is written for any kind of number is certain of its sign where `sign` says so. Numbers have to
// keep away from overflow and underflow, by which a product would be off too; kLeastError pays for the
// latter.
namespace cscd {

// A real number within `error` of `value`. `Value` is a double or a pair of doubles.
template <class Value>
struct Approximate {
  Value value{};
  double error = 0;

  int sign() const { return (head() > error) - (head() < -error); }
  double head() const {
    if constexpr (std::is_same_v<Value, double>)
      return value;
    else
      return value.high;
  }
};

namespace approximate {
constexpr double kLeastError = 0x1p-900;
// The largest relative error of one operation, and what pays for the roundings of errors. The head of a pair
// is off by half an ulp from the pair.
template <class Value>
constexpr double kRounding = std::is_same_v<Value, double> ? 1.01 * kUnitRoundoff : 0x1p-102;
constexpr double kOutward = 1 + 0x1p-48;
}  // namespace approximate

template <class Value>
Approximate<Value> operator+(const Approximate<Value>& a, const Approximate<Value>& b) {
  using namespace approximate;
  const double rounded = kRounding<Value> * (std::abs(a.head()) + std::abs(b.head()));
  return {a.value + b.value, kOutward * (a.error + b.error + rounded)};
}
template <class Value>
Approximate<Value> operator-(const Approximate<Value>& a, const Approximate<Value>& b) {
  return a + Approximate<Value>{-b.value, b.error};
}
template <class Value>
Approximate<Value> operator*(const Approximate<Value>& a, const Approximate<Value>& b) {
  using namespace approximate;
  const double x = std::abs(a.head()), y = std::abs(b.head());
  return {a.value * b.value,
          kOutward * (x * b.error + (y + b.error) * a.error + kRounding<Value> * (x * y)) + kLeastError};
}

// A function's value and its derivative with respect to time.
template <class Number>
struct WithSlope {
  Number value, slope;
};
template <class Number>
WithSlope<Number> operator+(const WithSlope<Number>& a, const WithSlope<Number>& b) {
  return {a.value + b.value, a.slope + b.slope};
}
template <class Number>
WithSlope<Number> operator-(const WithSlope<Number>& a, const WithSlope<Number>& b) {
  return {a.value - b.value, a.slope - b.slope};
}
template <class Number>
WithSlope<Number> operator*(const WithSlope<Number>& a, const WithSlope<Number>& b) {
  return {a.value * b.value, a.value * b.slope + a.slope * b.value};
}

}  // namespace cscd
