#include "core/elementary/certified/doubles_stage.h"

#include <gtest/gtest.h>
#include <random>
#include <vector>

namespace cscd {
namespace {

// The error of a cubic pays for what is computed from it: that of the coefficients, and ten roundings of the
// largest one. Both are scaled. Mutations: one of the two is left out or not scaled; ten roundings are one.
TEST(CubicInDoubles, RuleErrorBoundItsErrorPaysForWhatIsComputedFromIt) {
  for (std::size_t largest = 0; largest < 4; ++largest)
    for (const double size : {-8.0, 0.0, 1.0})
      for (const double error : {0.0, 1e-30, 1e-3})
        for (const double scale : {1.0, 3.0}) {
          BernsteinCubic cubic{{0.25, -0.25, 0.25, 0.25}, error};
          cubic.c[largest] = size;
          const double needed = scale * (error + 10 * kUnitRoundoff * std::max(0.25, std::abs(size)));
          const double paid = CubicOf<double>(cubic, scale).error;
          EXPECT_GE(paid, needed * (1 - 1e-15));
          EXPECT_LE(paid, needed * (1 + 1e-15));
        }
}

// Signs are certain beyond the error on either side, and only there.
TEST(CubicInDoubles, SignsAreCertainBeyondTheError) {
  const CubicOf<double> cubic({{1, 1, 1, 1}, 0.5}, 1);
  const double error = cubic.error;
  EXPECT_EQ(cubic.sign(std::nextafter(error, 1)), 1);
  EXPECT_EQ(cubic.sign(error), 0);
  EXPECT_EQ(cubic.sign(-error), 0);
  EXPECT_EQ(cubic.sign(std::nextafter(-error, -1)), -1);
}

// The slope is that of the exact derivative. Mutations: a coefficient or a power is taken for another.
TEST(CubicInDoubles, SlopeIsTheDerivative) {
  std::mt19937_64 random(8);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int i = 0; i < 200; ++i) {
    const BernsteinCubic cubic{{unit(random), unit(random), unit(random), unit(random)}, 0};
    const double t = i < 2 ? i : 0.5 + 0.5 * unit(random), step = 1e-6;
    EXPECT_NEAR(CubicOf<double>(cubic, 1).slope(t), (cubic.at(t + step) - cubic.at(t - step)) / (2 * step),
                1e-8);
  }
}

// Counts the changes of sign of control points.
int changes_of_sign(const std::vector<int>& signs) {
  int changes = 0, last = 0;
  for (const int sign : signs) {
    changes += sign * last < 0;
    if (sign != 0) last = sign;
  }
  return changes;
}

// Every combination of control points that are certainly positive, certainly negative or uncertain. An
// uncertain one may have any sign, and the number of roots has to follow by Descartes' rule whatever it is.
// Mutations: an uncertain control point counts as one of a certain sign; a sign is taken for another.
TEST(CountRoots, IsRightWhateverSignsUncertainControlPointsHave) {
  const CubicOf<double> cubic({{1, 1, 1, 1}, 0.5}, 1);
  std::vector<std::vector<int>> all{{}};
  for (int k = 0; k < 4; ++k) {
    std::vector<std::vector<int>> longer;
    for (const std::vector<int>& signs : all)
      for (const int sign : {-1, 0, 1}) {
        longer.push_back(signs);
        longer.back().push_back(sign);
      }
    all = longer;
  }
  for (const std::vector<int>& signs : all) {
    bool always_none = signs.front() != 0 && signs.back() != 0;
    bool always_one = signs.front() * signs.back() < 0;
    for (const std::vector<int>& other : all) {
      bool possible = true;
      for (std::size_t k = 0; k < 4; ++k) possible &= signs[k] == 0 || other[k] == signs[k];
      if (!possible) continue;
      always_none &= changes_of_sign(other) == 0;
      always_one &= changes_of_sign(other) == 1;
    }
    const double control[4] = {2.0 * signs[0], 2.0 * signs[1], 2.0 * signs[2], 2.0 * signs[3]};
    const Roots expected = always_none ? Roots::none : always_one ? Roots::one : Roots::unclear;
    EXPECT_EQ(count_roots(cubic, control), expected)
        << signs[0] << " " << signs[1] << " " << signs[2] << " " << signs[3];
  }
}

}  // namespace
}  // namespace cscd
