#include "core/base/sum_above.h"

#include <cfloat>
#include <cmath>
#include <gmpxx.h>
#include <gtest/gtest.h>
#include <random>

namespace cscd {
namespace {

// Sums of numbers of very different and of nearly equal sizes. Mutations: the errors of the sums are left
// out; they are added with a rounding; the result always grows.
TEST(SumAbove, IsTheSmallestDoubleNotBelow) {
  std::mt19937_64 random(6);
  const auto any = [&] {
    const double mantissa =
        1 + static_cast<double>(random() % (std::uint64_t{1} << (random() % 53))) * 0x1p-52;
    return random() % 8 == 0 ? 0 : std::ldexp(mantissa, -static_cast<int>(random() % 120));
  };
  int rounded = 0;
  for (int i = 0; i < 100'000; ++i) {
    double x[3] = {any(), any(), any()};
    if (i % 3 == 0) x[1] = x[0] * std::ldexp(1.0, -static_cast<int>(random() % 56));
    const mpq_class exact = mpq_class(x[0]) + mpq_class(x[1]) + mpq_class(x[2]);
    const double above = sum_above(x[0], x[1], x[2]);
    ASSERT_GE(mpq_class(above), exact) << std::hexfloat << x[0] << " " << x[1] << " " << x[2];
    if (above > 0) {
      ASSERT_LT(mpq_class(std::nextafter(above, 0)), exact)
          << std::hexfloat << x[0] << " " << x[1] << " " << x[2];
    }
    rounded += mpq_class(x[0] + (x[1] + x[2])) < exact;
  }
  EXPECT_GT(rounded, 10'000);
  EXPECT_EQ(sum_above(1, 0x1p-53, 0), 1 + 0x1p-52);
  EXPECT_EQ(sum_above(1, 0x1p-1074, 0x1p-1074), 1 + 0x1p-52);
  EXPECT_EQ(sum_above(DBL_MAX, 0, 0), DBL_MAX);
  EXPECT_EQ(sum_above(DBL_MAX, 1, 0), HUGE_VAL);
  EXPECT_EQ(sum_above(0, DBL_MAX, DBL_MAX), HUGE_VAL);
}

}  // namespace
}  // namespace cscd
