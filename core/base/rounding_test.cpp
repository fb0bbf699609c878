#include "core/base/rounding.h"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <gmpxx.h>
#include <gtest/gtest.h>
#include <random>
#include <vector>

namespace cscd {
namespace {

constexpr float kInf = std::numeric_limits<float>::infinity();
constexpr double kInfD = std::numeric_limits<double>::infinity();

std::uint32_t bits_of(float x) {
  return std::bit_cast<std::uint32_t>(x);
}

// Returns whether `bound` is the largest float that is not above the finite number `exact`.
::testing::AssertionResult is_largest_float_below(float bound, const mpq_class& exact) {
  const auto at_most_exact = [&](float x) { return x == -kInf || (x < kInf && mpq_class(x) <= exact); };
  if (!at_most_exact(bound)) return ::testing::AssertionFailure() << bound << " is above " << exact.get_d();
  const float above = std::nextafter(bound, kInf);
  if (at_most_exact(above))
    return ::testing::AssertionFailure() << bound << " is not the tightest below " << exact.get_d();
  return ::testing::AssertionSuccess();
}

// Returns doubles of every kind: uniform bit patterns, all magnitudes of float, floats and their neighbours,
// midpoints between floats, and the ends of both ranges.
std::vector<double> assorted_doubles(std::size_t random_count, unsigned seed) {
  std::vector<double> values = {0.0,
                                1.0,
                                1.0 + 0x1p-24,  // halfway between floats
                                1.0 + 0x1p-24 + 0x1p-52,
                                1.0 + 0x1p-24 - 0x1p-53,
                                0x1p-24,
                                0x1p-53,
                                0x1p-80,
                                FLT_MAX,
                                0x1.ffffffp127,  // rounds to infinity as a float
                                std::nextafter(0x1.ffffffp127, 0),
                                0x1p128,
                                FLT_MIN,
                                FLT_TRUE_MIN,
                                FLT_TRUE_MIN / 2.0,
                                FLT_TRUE_MIN * 1.5,
                                0x1p-150,
                                DBL_MIN,
                                DBL_TRUE_MIN,
                                DBL_MAX,
                                DBL_MAX / 2,
                                0x1p1023};
  std::mt19937_64 random(seed);
  while (values.size() < random_count) {
    const double any = std::bit_cast<double>(random());
    if (std::isfinite(any)) values.push_back(any);
    const float f = std::bit_cast<float>(static_cast<std::uint32_t>(random()));
    if (!std::isfinite(f)) continue;
    const double d = f;
    values.push_back(d);
    values.push_back(std::nextafter(d, kInfD));
    values.push_back(std::nextafter(d, -kInfD));
    const float g = std::nextafter(f, kInf);
    if (std::isfinite(g)) values.push_back((d + static_cast<double>(g)) / 2);
  }
  const std::size_t count = values.size();
  for (std::size_t i = 0; i < count; ++i) values.push_back(-values[i]);
  return values;
}

TEST(NextBelow, SpecialValues) {
  EXPECT_EQ(next_below(kInf), FLT_MAX);
  EXPECT_EQ(next_below(-kInf), -kInf);
  EXPECT_EQ(next_below(-FLT_MAX), -kInf);
  EXPECT_EQ(next_below(0.0f), -FLT_TRUE_MIN);
  EXPECT_EQ(next_below(-0.0f), -FLT_TRUE_MIN);
  EXPECT_EQ(bits_of(next_below(FLT_TRUE_MIN)), bits_of(0.0f));
  EXPECT_EQ(next_below(-FLT_TRUE_MIN), -2 * FLT_TRUE_MIN);
  EXPECT_EQ(next_below(FLT_MIN), FLT_MIN - FLT_TRUE_MIN);
  EXPECT_EQ(next_below(1.0f), 1 - FLT_EPSILON / 2);
  EXPECT_EQ(next_below(-1.0f), -1 - FLT_EPSILON);
}

TEST(NextBelow, IsNextafterOnOneBitPatternIn61) {
  std::uint64_t checked = 0;
  for (std::uint64_t pattern = 0; pattern <= 0xffffffff; pattern += 61) {
    const float x = std::bit_cast<float>(static_cast<std::uint32_t>(pattern));
    if (std::isnan(x)) continue;
    // If nextafter reaches a zero from above, the zero is +0, and so is that of next_below.
    ASSERT_EQ(bits_of(next_below(x)), bits_of(std::nextafter(x, -kInf))) << pattern;
    ++checked;
  }
  EXPECT_GT(checked, 70'000'000u);
}

TEST(NextBelow, KeepsNotANumber) {
  for (const std::uint32_t pattern : {0x7fc00000u, 0x7fffffffu, 0xffffffffu, 0x7f800001u})
    EXPECT_TRUE(std::isnan(next_below(std::bit_cast<float>(pattern)))) << pattern;
}

TEST(FloatBelow, IsTheLargestFloatNotAbove) {
  for (const double x : assorted_doubles(60'000, 1)) ASSERT_TRUE(is_largest_float_below(float_below(x), x));
  EXPECT_EQ(float_below(kInfD), kInf);
  EXPECT_EQ(float_below(-kInfD), -kInf);
  EXPECT_TRUE(std::isnan(float_below(std::numeric_limits<double>::quiet_NaN())));
}

TEST(FloatBelowSum, IsTheLargestFloatNotAboveTheExactSumOfAnyTwo) {
  const std::vector<double> values = assorted_doubles(4'000, 2);
  std::mt19937_64 random(3);
  for (int i = 0; i < 150'000; ++i) {
    const double x = values[random() % values.size()], y = values[random() % values.size()];
    ASSERT_TRUE(is_largest_float_below(float_below_sum(x, y), mpq_class(x) + mpq_class(y)))
        << std::hexfloat << x << " + " << y;
  }
}

// All pairs of the special values: sums that overflow float and double, subnormals and halfway cases.
TEST(FloatBelowSum, HoldsForEveryPairOfSpecialValues) {
  const std::vector<double> values = assorted_doubles(0, 0);
  for (const double x : values)
    for (const double y : values)
      ASSERT_TRUE(is_largest_float_below(float_below_sum(x, y), mpq_class(x) + mpq_class(y)))
          << std::hexfloat << x << " + " << y;
}

// The hard cases: the sum in doubles is a float, or a midpoint of two floats, but the
// exact sum lies a hair beside it.
TEST(FloatBelowSum, SeesWhatTheDoubleSumLost) {
  std::mt19937_64 random(4);
  int lost = 0;
  for (int i = 0; i < 100'000; ++i) {
    const float f = std::bit_cast<float>(static_cast<std::uint32_t>(random()));
    if (!std::isfinite(f) || std::abs(f) > FLT_MAX / 2) continue;
    const double middle = (static_cast<double>(f) + static_cast<double>(std::nextafter(f, kInf))) / 2;
    for (const double sum : {static_cast<double>(f), middle}) {
      const double hair = std::ldexp(sum, -54 - static_cast<int>(random() % 60));
      for (const double y : {hair, -hair}) {
        const mpq_class exact = mpq_class(sum) + mpq_class(y);
        ASSERT_TRUE(is_largest_float_below(float_below_sum(sum, y), exact));
        ASSERT_TRUE(is_largest_float_below(float_below_sum(y, sum), exact));
        lost += mpq_class(sum + y) != exact;
      }
    }
  }
  EXPECT_GT(lost, 100'000);  // many of these sums lose the hair
}

TEST(FloatBelowSum, CancelsExactly) {
  EXPECT_EQ(float_below_sum(DBL_MAX, -DBL_MAX), 0);
  EXPECT_EQ(float_below_sum(1e300, -1e300), 0);
  EXPECT_EQ(float_below_sum(DBL_MAX, DBL_MAX), FLT_MAX);
  EXPECT_EQ(float_below_sum(-DBL_MAX, -DBL_MAX), -kInf);
  EXPECT_EQ(float_below_sum(1, -DBL_TRUE_MIN), 1 - FLT_EPSILON / 2);
  EXPECT_EQ(float_below_sum(1, DBL_TRUE_MIN), 1);
  EXPECT_EQ(float_below_sum(0, -DBL_TRUE_MIN), -FLT_TRUE_MIN);
}

}  // namespace
}  // namespace cscd
