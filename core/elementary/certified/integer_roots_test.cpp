#include "core/elementary/certified/integer_roots.h"

#include <gtest/gtest.h>
#include <random>

#include "core/elementary/exact/algebraic.h"

namespace cscd::integer {
namespace {

// A polynomial in the types of this solver and of the oracle's solver.
struct Both {
  Polynomial ours;
  exact::Polynomial oracle;
};

Both both(const std::vector<std::int64_t>& c) {
  Both p;
  exact::Integer terms[4];
  for (std::size_t i = 0; i < c.size(); ++i) {
    p.ours.c[i] = Wide(c[i]);
    terms[i] = c[i];
  }
  p.ours.trim();
  p.oracle = exact::Polynomial(terms[0], terms[1], terms[2], terms[3]);
  return p;
}

class Polynomials {
 public:
  explicit Polynomials(unsigned seed) : random_(seed) {}
  std::int64_t in(std::int64_t low, std::int64_t high) {
    return std::uniform_int_distribution<std::int64_t>(low, high)(random_);
  }
  // Returns coefficients by ascending power. They are a product of factors m t - n with roots in or near
  // [0, 1], so that roots fall together, on ends, and on dyadic points; or any small integers; or such a
  // product with one coefficient a little off.
  std::vector<std::int64_t> any(int degree = 3) {
    const auto kind = in(0, 3);
    if (kind == 0) {
      std::vector<std::int64_t> p;
      for (int i = 0; i <= degree; ++i) p.push_back(in(-9, 9));
      return p;
    }
    const std::int64_t largest = kind == 1 ? 4 : 50'000;
    std::vector<std::int64_t> p{in(0, 1) ? 1 : -1};
    std::int64_t m = 1, n = 0;
    for (std::int64_t factors = in(1, degree); factors > 0; --factors) {
      if (p.size() == 1 || in(0, 2) > 0) {
        m = in(1, largest);
        n = in(-1, m + 1);
      }
      std::vector<std::int64_t> next(p.size() + 1, 0);
      for (std::size_t i = 0; i < p.size(); ++i) {
        next[i] -= n * p[i];
        next[i + 1] += m * p[i];
      }
      p = next;
    }
    if (kind == 3) p[static_cast<std::size_t>(in(0, static_cast<std::int64_t>(p.size()) - 1))] += in(-1, 1);
    return p;
  }

 private:
  std::mt19937_64 random_;
};

TEST(IntegerRoots, AgreeWithTheOracles) {
  Polynomials polynomials(5);
  int roots_seen = 0, zero_signs = 0, repeated = 0, gave_up = 0;
  for (int i = 0; i < 60'000; ++i) {
    const Both p = both(polynomials.any()), q = both(polynomials.any(2));
    if (p.ours.is_zero()) continue;
    auto expected = exact::roots_in_unit_interval(p.oracle);
    RootSolver solver;
    Root roots[3];
    const int count = solver.find_roots(p.ours, roots);
    gave_up += solver.gave_up();
    if (solver.gave_up()) continue;
    ASSERT_EQ(count, static_cast<int>(expected.size())) << i;
    repeated += count > 0 && count < p.ours.degree;
    for (int k = 0; k < count; ++k) {
      auto& root = expected[static_cast<std::size_t>(k)];
      if (i % 2) solver.tighten(roots[k]);  // signs must not depend on whether the root is tight
      const int sign = solver.sign_at(q.ours, roots[k]);
      ASSERT_EQ(sign, root.sign_of(q.oracle)) << i << ", root " << k;
      zero_signs += sign == 0 && !q.ours.is_zero();
      solver.tighten(roots[k]);
      ASSERT_FALSE(solver.gave_up());
      ASSERT_EQ(roots[k].low, root.enclosure().lo) << i << ", root " << k;
      ++roots_seen;
    }
  }
  EXPECT_EQ(gave_up, 0);
  EXPECT_GT(roots_seen, 10'000);
  EXPECT_GT(zero_signs, 100);
  EXPECT_GT(repeated, 100);
}

// Two polynomials have roots that are equal or apart by far less than the spacing of doubles.
TEST(IntegerRoots, TellsRootsApartFarBelowTheSpacingOfDoubles) {
  // p = 3 t - 1 has its root at 1/3, and q = (3 N) t - (N + e) has its root at 1/3 + e / (3 N), with
  // N = 2^places.
  for (const int places : {60, 250, 1000}) {
    for (const int e : {-1, 0, 1}) {
      Polynomial p, q;
      p.c[0] = Wide(-1);
      p.c[1] = Wide(3);
      q.c[0] = -(Wide(1) << places) - Wide(e);
      q.c[1] = Wide(3) << places;
      p.trim();
      q.trim();
      RootSolver solver;
      Root roots[3];
      ASSERT_EQ(solver.find_roots(p, roots), 1);
      EXPECT_EQ(solver.sign_at(q, roots[0]), -e);
      EXPECT_FALSE(solver.gave_up());
    }
  }
}

Wide wide(const exact::Integer& value) {
  Wide result;
  const exact::Integer size = abs(value);
  for (unsigned bit = size == 0 ? 0 : msb(size) + 1; bit-- > 0;)
    result = (result << 1) + Wide(bit_test(size, bit) ? 1 : 0);
  return value.sign() < 0 ? -result : result;
}

// Polynomials have two roots that are about 2^(-places/2) apart, between the same two doubles, or miss
// having them by as little. The test also compares signs of other polynomials that turn at the same place.
TEST(IntegerRoots, TellsPairsApartFarBelowTheSpacingOfDoubles) {
  // A polynomial that has a double root at 1/3 for off = 0, and nearly has one otherwise. Degree 1 has a
  // single root.
  const auto near_third = [](int degree, int places, int off) {
    const exact::Integer one = exact::Integer(1) << static_cast<unsigned>(places);
    Both p;
    exact::Integer c[4] = {one, -6 * one, 9 * one, 0};  // (3 t - 1)^2
    if (degree == 1) c[0] = -one, c[1] = 3 * one, c[2] = 0;
    if (degree == 3) c[3] = 9 * one, c[2] = 12 * one, c[1] = -11 * one, c[0] = 2 * one;  // times t + 2
    c[0] += off;
    for (int i = 0; i < 4; ++i) p.ours.c[i] = wide(c[i]);
    p.ours.trim();
    p.oracle = exact::Polynomial(c[0], c[1], c[2], c[3]);
    return p;
  };
  int pairs = 0;
  for (const int places : {110, 200, 340})
    for (const int degree : {2, 3})
      for (const int off : {-2, -1, 1}) {
        const Both p = near_third(degree, places, off);
        auto expected = exact::roots_in_unit_interval(p.oracle);
        RootSolver solver;
        Root roots[3];
        ASSERT_EQ(solver.find_roots(p.ours, roots), static_cast<int>(expected.size()));
        ASSERT_FALSE(solver.gave_up());
        pairs += expected.size() == 2;
        for (std::size_t k = 0; k < expected.size(); ++k) {
          EXPECT_EQ(roots[k].low, expected[k].enclosure().lo);
          for (const int q_places : {80, 110, 160, 200})
            for (const int q_degree : {1, 2})
              for (const int q_off : {-3, -1, 0, 1}) {
                const Both q = near_third(q_degree, q_places, q_off);
                EXPECT_EQ(solver.sign_at(q.ours, roots[k]), expected[k].sign_of(q.oracle))
                    << places << " " << degree << " " << off << ", root " << k << ": " << q_places << " "
                    << q_degree << " " << q_off;
              }
        }
        EXPECT_FALSE(solver.gave_up());
      }
  EXPECT_EQ(pairs, 12);
}

TEST(IntegerRoots, GivesUpOnNumbersThatDoNotFit) {
  Polynomial p;
  p.c[0] = Wide(-1);
  p.c[1] = Wide(1) << Wide::kBits - 196;
  p.c[2] = Wide(3) << Wide::kBits - 196;
  p.trim();
  RootSolver solver;
  Root roots[3];
  if (solver.find_roots(p, roots) == 1) solver.tighten(roots[0]);
  EXPECT_TRUE(solver.gave_up());
}

}  // namespace
}  // namespace cscd::integer
