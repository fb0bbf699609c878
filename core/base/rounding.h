#pragma once

#include <bit>
#include <cstdint>
#include <limits>

namespace cscd {

// Half the distance from 1 to the next double: the largest relative error of one correctly rounded operation.
inline constexpr double kUnitRoundoff = std::numeric_limits<double>::epsilon() / 2;

// Returns the next float below x. Minus infinity and NaN are returned unchanged. The function has no
// branches, so that compilers can vectorise loops that call it.
inline float next_below(float x) {
  const std::uint32_t bits = std::bit_cast<std::uint32_t>(x);
  // The bits of positive floats, read as integers, increase with the float; those of negative floats
  // decrease. Both zeros step to the first negative subnormal.
  const std::uint32_t stepped = x > 0 ? bits - 1 : bits + 1;
  const std::uint32_t smallest_negative = 0x80000001;
  const std::uint32_t chosen = x == 0 ? smallest_negative : stepped;
  return x > -std::numeric_limits<float>::infinity() ? std::bit_cast<float>(chosen) : x;
}

// Returns the largest float that is not above the exact sum x + y.
inline float float_below_sum(double x, double y) {
  const double sum = x + y;
  // Knuth's two-sum: sum + error == x + y exactly (in the absence of overflow).
  const double y_part = sum - x;
  const double error = (x - (sum - y_part)) + (y - y_part);
  const float nearest = static_cast<float>(sum);
  const double widened = static_cast<double>(nearest);
  // A sum that overflows to infinity stands for a finite number, so the result is the largest finite float.
  const bool above =
      widened > sum || (widened == sum && error < 0) || sum == std::numeric_limits<double>::infinity();
  return above ? next_below(nearest) : nearest;
}

// Returns the largest float that is not above x.
inline float float_below(double x) {
  const float nearest = static_cast<float>(x);
  return static_cast<double>(nearest) > x ? next_below(nearest) : nearest;
}
// Returns the smallest float that is not below x.
inline float float_not_below(double x) {
  return -float_below(-x);
}

}  // namespace cscd
