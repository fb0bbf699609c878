#pragma once

#include <bit>
#include <cstdint>
#include <limits>

namespace cscd {

// Returns the smallest double that is not below the exact sum of three numbers that are not negative. Where
// the sum overflows, it is infinity.
inline double sum_above(double x, double y, double z) {
  struct Parts {
    double sum, error;
  };
  const auto two_sum = [](double a, double b) {
    const double sum = a + b, b_part = sum - a;
    return Parts{sum, (a - (sum - b_part)) + (b - b_part)};
  };
  const Parts first = two_sum(y, z), second = two_sum(x, first.sum);
  if (!(second.sum <= std::numeric_limits<double>::max())) return second.sum;
  const Parts errors = two_sum(first.error, second.error), all = two_sum(second.sum, errors.sum);
  // The exact sum is all.sum + all.error + errors.error, and the sign of a rounded sum is right.
  return all.error + errors.error > 0 ? std::bit_cast<double>(std::bit_cast<std::uint64_t>(all.sum) + 1)
                                      : all.sum;
}

}  // namespace cscd
