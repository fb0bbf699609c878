#include "core/elementary/certified/wide.h"

#include <gmpxx.h>
#include <gtest/gtest.h>
#include <random>

namespace cscd {
namespace {

// A number in both arithmetics.
struct Both {
  Wide wide;
  mpz_class gmp;
};

class Numbers {
 public:
  explicit Numbers(unsigned seed) : random_(seed) {}
  // A number of at most so many words. It has runs of zeros and ones, so that carries go far.
  Both any(int words) {
    Both x;
    for (int i = static_cast<int>(random_() % static_cast<unsigned>(words + 1)); i > 0; --i) {
      const std::uint64_t kind = random_() % 4;
      const std::int64_t word = kind == 0   ? 0
                                : kind == 1 ? -1
                                : kind == 2 ? std::int64_t{1} << random_() % 63
                                            : static_cast<std::int64_t>(random_());
      x.wide = (x.wide << 64) + Wide(word);
      x.gmp = (x.gmp << 64) + word;
    }
    if (random_() % 2) x.wide = -x.wide, x.gmp = -x.gmp;
    return x;
  }
  int below(int n) { return static_cast<int>(random_() % static_cast<unsigned>(n)); }

 private:
  std::mt19937_64 random_;
};

void expect_same(const Wide& wide, const mpz_class& gmp) {
  ASSERT_EQ(wide.sign(), sgn(gmp));
  ASSERT_EQ(wide.bits(), gmp == 0 ? 0 : static_cast<int>(mpz_sizeinbase(gmp.get_mpz_t(), 2)));
  Wide rest = wide;
  mpz_class gmp_rest = gmp;
  // Take the leading digits off, one after the other, until nothing is left.
  for (int step = 0; rest.sign() != 0; ++step) {
    ASSERT_LT(step, Wide::kBits);
    const Wide::Leading lead = rest.leading();
    long exponent = 0;
    const double expected = mpz_get_d_2exp(&exponent, gmp_rest.get_mpz_t());
    ASSERT_NEAR(std::ldexp(lead.value, static_cast<int>(lead.exponent - exponent)), expected, 0x1p-51);
    const int bit = rest.bits() - 1;
    Wide power = Wide(rest.sign()) << bit;
    mpz_class gmp_power = mpz_class(sgn(gmp_rest)) << bit;
    rest = rest - power;
    gmp_rest -= gmp_power;
  }
  ASSERT_EQ(gmp_rest, 0);
}

// Factors of 144 and 145 words, of which the product has 288. Mutation: there are no more words than that,
// which the sanitizers tell.
TEST(Wide, TheLongestProductHasRoomForTheWordsOfItsFactors) {
  const auto power = [](int exponent) { return Both{Wide(1) << exponent, mpz_class(1) << exponent}; };
  const Both a = power(9152), b = power(9278);
  ASSERT_EQ(a.wide.bits() + b.wide.bits(), Wide::kBits);
  expect_same(a.wide * b.wide, a.gmp * b.gmp);
  expect_same(b.wide * a.wide, a.gmp * b.gmp);
}

TEST(Wide, AgreesWithGmp) {
  Numbers numbers(3);
  for (int i = 0; i < 3000; ++i) {
    const Both a = numbers.any(1 + i % 15), b = numbers.any(1 + i % 16);
    expect_same(a.wide + b.wide, a.gmp + b.gmp);
    expect_same(a.wide - b.wide, a.gmp - b.gmp);
    expect_same(a.wide * b.wide, a.gmp * b.gmp);
    expect_same(a.wide - a.wide, 0);
    const int places = numbers.below(300);
    expect_same(a.wide << places, a.gmp << places);
    expect_same(-a.wide, -a.gmp);
    if (HasFatalFailure()) return;
  }
}

TEST(Wide, HoldsItsFullWidth) {
  const Wide one(1);
  Wide full = (one << (Wide::kBits - 1)) - one;
  full = full + full + one;
  EXPECT_EQ(full.bits(), Wide::kBits);
  EXPECT_EQ((full - full).sign(), 0);
  EXPECT_EQ((one << (Wide::kBits - 1)).bits(), Wide::kBits);
  const Wide half = (one << Wide::kBits / 2) - one;
  EXPECT_EQ((half * half).bits(), Wide::kBits);
}

TEST(Wide, HoldsTheSmallestInteger) {
  expect_same(Wide(INT64_MIN), mpz_class(static_cast<long>(INT64_MIN)));
}

}  // namespace
}  // namespace cscd
