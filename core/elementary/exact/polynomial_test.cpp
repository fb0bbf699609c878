#include "core/elementary/exact/polynomial.h"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <random>
#include <vector>

#include "core/elementary/exact/algebraic.h"
#include "core/elementary/exact/test_brute_oracle.h"

namespace cscd::exact {
namespace {

// The product of (d t - n) over the fractions n / d.
Polynomial with_roots(const std::vector<std::pair<long, long>>& fractions) {
  Polynomial product(Integer(1));
  for (const auto& [n, d] : fractions) product = product * Polynomial(Integer(-n), Integer(d));
  return product;
}

Polynomial cubic(long c0, long c1, long c2, long c3) {
  return Polynomial(c0, c1, c2, c3);
}

mpz_class gmp(const Integer& x) {
  return mpz_class(x.str());
}

// GMP computes the same. Mutation: `truncated` rounds to the nearest double.
TEST(Integer, AgreesWithGmp) {
  std::mt19937_64 random(3);
  const auto any = [&] {
    Integer x = 0;
    for (auto words = random() % 20; words > 0; --words) x = (x << 64) + random();
    return (random() % 2 != 0 ? Integer(-x) : x) << (random() % 70);
  };
  for (int i = 0; i < 3'000; ++i) {
    const Integer a = any(), b = any();
    const mpz_class x = gmp(a), y = gmp(b);
    ASSERT_EQ(gmp(a + b), x + y);
    ASSERT_EQ(gmp(a - b), x - y);
    ASSERT_EQ(gmp(a * b), x * y);
    ASSERT_EQ(gmp(gcd(a, b)), gcd(x, y));
    ASSERT_EQ(a.compare(b) > 0, cmp(x, y) > 0);
    ASSERT_EQ(a.sign(), sgn(x));
    if (a == 0) continue;
    ASSERT_EQ(a * b / a, b);
    ASSERT_EQ(trailing_zeros(a), mpz_scan1(x.get_mpz_t(), 0));
    long exponent = 0, expected = 0;
    ASSERT_EQ(truncated(a, exponent), mpz_get_d_2exp(&expected, x.get_mpz_t()));
    ASSERT_EQ(exponent, expected);
  }
}

TEST(Dyadic, HoldsEveryKindOfDoubleExactly) {
  for (const double x : {0.0, 1.0, -1.5, 0.1, 1e150, -1e-300, 0x1p-1074, 0x1.fffffffffffffp+1023}) {
    const Dyadic exact = dyadic(x);
    EXPECT_EQ(mpq_class(gmp(exact.numerator), mpz_class(1) << exact.exponent), mpq_class(x)) << x;
  }
}

// scripts/test builds with assertions. Mutation: it builds without them, and this test is skipped.
TEST(DyadicDeathTest, AssertsThatTheNumberIsFinite) {
#ifdef NDEBUG
  GTEST_SKIP() << "built without assertions";
#else
  EXPECT_DEATH(dyadic(std::numeric_limits<double>::infinity()), "isfinite");
#endif
}

TEST(Dyadic, ComparesAndHalvesAcrossExponents) {
  EXPECT_LT(compare(dyadic(0.25), dyadic(0.5)), 0);
  EXPECT_GT(compare(dyadic(3.0), dyadic(0x1p-1074)), 0);
  EXPECT_EQ(compare(dyadic(0.75), Dyadic{Integer(12), 4}), 0);
  EXPECT_EQ(compare(midpoint(dyadic(0.25), dyadic(1)), dyadic(0.625)), 0);
}

TEST(Dyadic, RoundsOutwardToNeighbours) {
  const Dyadic third_and_a_bit{(Integer(1) << 200) / 3, 200};
  const double below = double_below(third_and_a_bit), above = double_above(third_and_a_bit);
  EXPECT_LT(compare(dyadic(below), third_and_a_bit), 0);
  EXPECT_GT(compare(dyadic(above), third_and_a_bit), 0);
  EXPECT_EQ(std::nextafter(below, 1), above);
  EXPECT_EQ(double_below(dyadic(0.1)), 0.1);
  EXPECT_EQ(double_above(dyadic(0.1)), 0.1);
  // The processor would round three quarters of the smallest subnormal up.
  const Dyadic tiny{Integer(3), 1076};
  EXPECT_EQ(double_below(tiny), 0);
  EXPECT_EQ(double_above(tiny), 0x1p-1074);
}

TEST(Polynomial, KnowsItsDegree) {
  EXPECT_EQ(Polynomial().degree(), -1);
  EXPECT_EQ(cubic(0, 0, 0, 0).degree(), -1);
  EXPECT_EQ(cubic(5, 0, 0, 0).degree(), 0);
  EXPECT_EQ(cubic(1, 2, 3, 4).degree(), 3);
  EXPECT_EQ((cubic(1, 2, 3, 4) - cubic(1, 0, 0, 4)).degree(), 2);
}

TEST(Polynomial, MultipliesAndDividesBack) {
  const Polynomial a(Integer(-2), Integer(3)), b = cubic(5, -7, 11, 0), product = a * b;
  EXPECT_EQ(product, cubic(-10, 29, -43, 33));
  EXPECT_EQ(exact_quotient(product, a), b);
  EXPECT_EQ(exact_quotient(product, b), a);
  Polynomial rest = product;
  rest.subtract_product(a, b);
  EXPECT_TRUE(rest.is_zero());
}

TEST(Polynomial, StretchesAnIntervalOntoTheUnitInterval) {
  const Polynomial p = cubic(3, -5, 7, -2);
  const Dyadic from = dyadic(0.375), to = dyadic(0.625);
  const Polynomial q = p.stretched(from, to);
  for (const double s : {0.0, 0.125, 0.5, 1.0}) {
    const mpq_class t = mpq_class(0.375) + mpq_class(s) * mpq_class(0.25);
    const mpq_class direct = 3 - 5 * t + 7 * t * t - 2 * t * t * t;
    const mpq_class u(s);
    EXPECT_EQ(gmp(q[0]) + gmp(q[1]) * u + gmp(q[2]) * u * u + gmp(q[3]) * u * u * u, 512 * direct) << s;
  }
}

TEST(Polynomial, FindsTheCommonDivisor) {
  const Polynomial a = with_roots({{1, 3}, {2, 5}, {7, 2}}), b = with_roots({{2, 5}, {9, 4}});
  const Polynomial shared = greatest_common_divisor(a, b);
  EXPECT_EQ(shared.degree(), 1);
  EXPECT_EQ(shared[0] * 5, shared[1] * -2);
  EXPECT_EQ(greatest_common_divisor(a, with_roots({{1, 7}})).degree(), 0);
  EXPECT_EQ(greatest_common_divisor(Polynomial(), b), b.primitive_part());
}

TEST(Polynomial, EvaluatesSigns) {
  const Polynomial p = with_roots({{1, 4}, {1, 2}, {3, 4}});
  const int expected[] = {-1, 0, 1, 0, -1, 0, 1};
  const double at[] = {0, 0.25, 0.3, 0.5, 0.6, 0.75, 1};
  for (int i = 0; i < 7; ++i) EXPECT_EQ(sign_at(p, dyadic(at[i])), expected[i]) << at[i];
  for (const double t : at) EXPECT_EQ(sign_at(Polynomial(), dyadic(t)), 0);
}

TEST(UnitIntervalSigns, CountRootsOrSayNone) {
  EXPECT_EQ(signs_on_unit_interval(with_roots({{1, 3}})).variations, 1);
  EXPECT_EQ(signs_on_unit_interval(with_roots({{1, 3}, {1, 2}, {3, 4}})).variations, 3);
  const UnitIntervalSigns none = signs_on_unit_interval(with_roots({{-1, 3}, {5, 2}}));
  EXPECT_EQ(none.variations, 0);
  EXPECT_EQ(none.sign, -1);
  // A root at an end is not inside the open interval.
  const UnitIntervalSigns end = signs_on_unit_interval(with_roots({{0, 1}, {1, 1}}));
  EXPECT_EQ(end.variations, 0);
  EXPECT_EQ(end.sign, -1);
}

std::vector<TimeEnclosure> root_times(const Polynomial& p) {
  std::vector<TimeEnclosure> times;
  for (AlgebraicNumber& root : roots_in_unit_interval(p)) times.push_back(root.enclosure());
  return times;
}

TEST(Roots, AreFoundOnceEachInOrder) {
  const auto times = root_times(with_roots({{3, 4}, {1, 3}, {1, 2}}));
  ASSERT_EQ(times.size(), 3u);
  EXPECT_LT(times[0].lo, times[0].hi);
  EXPECT_EQ(times[0].hi, std::nextafter(times[0].lo, 1));
  EXPECT_LE(mpq_class(times[0].lo), mpq_class(1, 3));
  EXPECT_GE(mpq_class(times[0].hi), mpq_class(1, 3));
  for (const int i : {1, 2}) EXPECT_EQ(times[static_cast<std::size_t>(i)].lo, i == 1 ? 0.5 : 0.75);
  for (const int i : {1, 2}) EXPECT_EQ(times[static_cast<std::size_t>(i)].hi, i == 1 ? 0.5 : 0.75);
}

TEST(Roots, CountAtBothEndsAndWhenMultiple) {
  const auto ends = root_times(with_roots({{0, 1}, {1, 1}, {1, 2}}));
  ASSERT_EQ(ends.size(), 3u);
  EXPECT_EQ(ends[0].hi, 0);
  EXPECT_EQ(ends[2].lo, 1);
  for (const long multiplicity : {2, 3})
    for (const auto& [n, d] : std::vector<std::pair<long, long>>{{0, 1}, {1, 1}, {1, 2}, {1, 3}, {5, 8}}) {
      const auto times = root_times(
          with_roots(std::vector<std::pair<long, long>>(static_cast<std::size_t>(multiplicity), {n, d})));
      ASSERT_EQ(times.size(), 1u) << n << "/" << d << " times " << multiplicity;
      EXPECT_LE(mpq_class(times[0].lo), mpq_class(n, d));
      EXPECT_GE(mpq_class(times[0].hi), mpq_class(n, d));
    }
  const auto mixed = root_times(with_roots({{1, 3}, {2, 3}, {1, 3}}));
  ASSERT_EQ(mixed.size(), 2u);
  EXPECT_LT(mixed[0].hi, mixed[1].lo);
}

TEST(Roots, OutsideTheUnitIntervalAreNotReported) {
  EXPECT_TRUE(root_times(with_roots({{-1, 3}, {4, 3}, {-5, 1}})).empty());
  EXPECT_TRUE(root_times(cubic(1, 0, 1, 0)).empty());
  EXPECT_TRUE(root_times(Polynomial(Integer(7))).empty());
  EXPECT_TRUE(root_times(Polynomial(Integer(1) << 2000, Integer(1))).empty());
  // 4 t^2 - 4 t + 1, raised by one part in 2^200, is a near miss that only exact arithmetic sees.
  const Integer big = Integer(1) << 200;
  EXPECT_TRUE(root_times(Polynomial(big + 1, -4 * big, 4 * big, 0)).empty());
  EXPECT_EQ(root_times(Polynomial(big - 1, -4 * big, 4 * big, 0)).size(), 2u);
}

TEST(Roots, MuchCloserThanDoublesAreToldApart) {
  // The polynomial is (2^100 t - a)(2^100 t - a - 1), with a / 2^100 near one third.
  const Integer scale = Integer(1) << 100, a = scale / 3;
  const Polynomial first(-a, scale), second(-a - 1, scale);
  auto roots = roots_in_unit_interval(first * second);
  ASSERT_EQ(roots.size(), 2u);
  EXPECT_EQ(roots[0].sign_of(first), 0);
  EXPECT_EQ(roots[0].sign_of(second), -1);
  EXPECT_EQ(roots[1].sign_of(first), 1);
  EXPECT_EQ(roots[1].sign_of(second), 0);
  EXPECT_EQ(roots[0].enclosure().hi, std::nextafter(roots[0].enclosure().lo, 1));
  EXPECT_EQ(roots[0].enclosure().lo, roots[1].enclosure().lo);
}

TEST(Roots, TinyOnesAreEnclosedByNeighbouringDoubles) {
  // The roots are t = 1 / (3 * 2^900) and t = 1 / 2^1100, which is below every positive double.
  const auto small = root_times(Polynomial(Integer(-1), 3 * (Integer(1) << 900)));
  ASSERT_EQ(small.size(), 1u);
  EXPECT_GT(small[0].lo, 0);
  EXPECT_EQ(small[0].hi, std::nextafter(small[0].lo, 1));
  const auto least = root_times(Polynomial(Integer(-1), Integer(1) << 1100));
  ASSERT_EQ(least.size(), 1u);
  EXPECT_EQ(least[0].lo, 0);
  EXPECT_EQ(least[0].hi, 0x1p-1074);
}

TEST(Roots, OfAllSmallCubicsMatchSturmSequences) {
  for (long c0 = -3; c0 <= 3; ++c0)
    for (long c1 = -3; c1 <= 3; ++c1)
      for (long c2 = -3; c2 <= 3; ++c2)
        for (long c3 = -3; c3 <= 3; ++c3) {
          const Polynomial p = cubic(c0, c1, c2, c3);
          if (p.is_zero()) continue;
          SCOPED_TRACE(testing::Message() << c0 << " " << c1 << " " << c2 << " " << c3);
          auto roots = roots_in_unit_interval(p);
          const auto expected = brute::unit_roots(brute::trimmed({c0, c1, c2, c3}));
          ASSERT_EQ(roots.size(), expected.size());
          for (std::size_t i = 0; i < roots.size(); ++i) {
            const TimeEnclosure time = roots[i].enclosure();
            EXPECT_GE(expected[i].sign_of({-mpq_class(time.lo), 1}), 0);
            EXPECT_LE(expected[i].sign_of({-mpq_class(time.hi), 1}), 0);
            // Compare the signs of other polynomials at the root. Some of these share the root.
            for (const auto& q :
                 {cubic(-1, 1, 1, 0), cubic(-1, 2, 0, 0), cubic(1, -2, -1, 1), cubic(c0, c1, 0, 0)}) {
              const brute::Poly same{gmp(q[0]), gmp(q[1]), gmp(q[2]), gmp(q[3])};
              EXPECT_EQ(roots[i].sign_of(q), expected[i].sign_of(brute::trimmed(same)));
            }
          }
        }
}

}  // namespace
}  // namespace cscd::exact
