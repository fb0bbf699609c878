#include "core/elementary/certified/doubles_stage.h"

#include <gtest/gtest.h>
#include <random>

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

}  // namespace
}  // namespace cscd
