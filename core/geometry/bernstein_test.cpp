#include "core/geometry/bernstein.h"

#include <array>
#include <cmath>
#include <functional>
#include <gmpxx.h>
#include <gtest/gtest.h>
#include <random>

namespace cscd {
namespace {

using Exact = std::array<mpq_class, 3>;

Exact difference(const Vec3& to, const Vec3& from) {
  Exact d;
  for (int k = 0; k < 3; ++k) d[static_cast<std::size_t>(k)] = mpq_class(to[k]) - mpq_class(from[k]);
  return d;
}
mpq_class triple(const Exact& a, const Exact& b, const Exact& c) {
  return (a[1] * b[2] - a[2] * b[1]) * c[0] + (a[2] * b[0] - a[0] * b[2]) * c[1] +
         (a[0] * b[1] - a[1] * b[0]) * c[2];
}

// Three moving vectors as differences of points, as in the code that uses them.
struct Points {
  Vec3 from_start[3], from_end[3], to_start[3], to_end[3];

  MovingVector vector(int i) const { return {to_start[i] - from_start[i], to_end[i] - from_end[i]}; }
  BernsteinCubic cubic(double c_slack = 0) const {
    return triple_product(vector(0), vector(1), vector(2), c_slack);
  }
  // The coefficients for the exact differences, with `shift_start` and `shift_end` added to c.
  std::array<mpq_class, 4> exact(const Exact& shift_start = {}, const Exact& shift_end = {}) const {
    Exact v[3][2];
    for (int i = 0; i < 3; ++i) {
      v[i][0] = difference(to_start[i], from_start[i]);
      v[i][1] = difference(to_end[i], from_end[i]);
    }
    for (std::size_t k = 0; k < 3; ++k) v[2][0][k] += shift_start[k], v[2][1][k] += shift_end[k];
    const auto at = [&](int a, int b, int c) { return triple(v[0][a], v[1][b], v[2][c]); };
    return {at(0, 0, 0), (at(0, 1, 0) + at(1, 0, 0) + at(0, 0, 1)) / 3,
            (at(0, 1, 1) + at(1, 0, 1) + at(1, 1, 0)) / 3, at(1, 1, 1)};
  }
};

mpq_class value(const std::array<mpq_class, 4>& c, const mpq_class& t) {
  const mpq_class s = 1 - t;
  return s * s * s * c[0] + 3 * s * s * t * c[1] + 3 * s * t * t * c[2] + t * t * t * c[3];
}

using Random = std::mt19937_64;
double uniform(Random& random, double low = -1, double high = 1) {
  return std::uniform_real_distribution<double>(low, high)(random);
}
Vec3 any_vector(Random& random) {
  return {uniform(random), uniform(random), uniform(random)};
}

Points random_points(Random& random, double scale, const Vec3& offset) {
  Points p;
  for (int i = 0; i < 3; ++i)
    for (Vec3* x : {&p.from_start[i], &p.from_end[i], &p.to_start[i], &p.to_end[i]})
      *x = scale * any_vector(random) + offset;
  return p;
}

// All points lie in one plane up to the last bits of their coordinates, so the exact
// coefficients are rounding noise.
Points nearly_coplanar(Random& random, double offset) {
  Points p = random_points(random, 1, {offset, -offset, offset});
  const Vec3 u = any_vector(random), w = any_vector(random);
  for (int i = 0; i < 3; ++i)
    for (Vec3* x : {&p.from_start[i], &p.from_end[i], &p.to_start[i], &p.to_end[i]})
      *x = uniform(random) * u + uniform(random) * w + Vec3(offset, -offset, offset);
  return p;
}

// Vectors whose components have equal sizes and such signs that the products cancel.
Points cancelling(Random& random, double scale) {
  Points p;
  const auto pick = [&] { return scale * ((random() & 1) ? 1.0 : -1.0) * (1 + uniform(random) * 0x1p-45); };
  for (int i = 0; i < 3; ++i) {
    p.from_start[i] = p.from_end[i] = Vec3::Zero();
    p.to_start[i] = {pick(), pick(), pick()};
    p.to_end[i] = {pick(), pick(), pick()};
  }
  return p;
}

struct Family {
  const char* name;
  std::function<Points(Random&)> make;
};
const Family kFamilies[] = {
    {"unit", [](Random& r) { return random_points(r, 1, Vec3::Zero()); }},
    {"far",
     [](Random& r) {
       return random_points(r, 1, {1e6, -3e6, 2e5});
     }},
    {"very far",
     [](Random& r) {
       return random_points(r, 1, {1e15, -3e15, 2e14});
     }},
    {"huge", [](Random& r) { return random_points(r, 1e99, Vec3::Zero()); }},
    {"small", [](Random& r) { return random_points(r, 1e-90, Vec3::Zero()); }},
    {"too small", [](Random& r) { return random_points(r, 1e-150, Vec3::Zero()); }},
    {"at the small limit", [](Random& r) { return random_points(r, 6e-94, Vec3::Zero()); }},
    {"coplanar", [](Random& r) { return nearly_coplanar(r, 0); }},
    {"coplanar, far", [](Random& r) { return nearly_coplanar(r, 1e5); }},
    {"cancelling", [](Random& r) { return cancelling(r, 1); }},
    {"cancelling, huge", [](Random& r) { return cancelling(r, 1e99); }},
};

TEST(TripleProduct, CoefficientsAreWithinTheClaimedError) {
  Random random(1);
  double worst = 0;
  for (const Family& family : kFamilies) {
    double worst_here = 0;
    int known = 0;
    for (int i = 0; i < 3000; ++i) {
      const Points p = family.make(random);
      const BernsteinCubic f = p.cubic();
      if (!std::isfinite(f.error)) continue;
      ++known;
      const auto exact = p.exact();
      for (std::size_t k = 0; k < 4; ++k) {
        ASSERT_TRUE(std::isfinite(f.c[k])) << family.name;
        const mpq_class off = abs(mpq_class(f.c[k]) - exact[k]);
        ASSERT_LE(off, mpq_class(f.error)) << family.name << " coefficient " << k;
        worst_here = std::max(worst_here, mpq_class(off / mpq_class(f.error)).get_d());
      }
    }
    RecordProperty(std::string("worst error over bound, ") + family.name, std::to_string(worst_here));
    EXPECT_EQ(known == 0, std::string(family.name) == "too small") << family.name;
    worst = std::max(worst, worst_here);
  }
  // The bound is not absurdly loose: some input comes within a factor of 50.
  EXPECT_GT(worst, 0.02);
  RecordProperty("worst error over bound", std::to_string(worst));
}

TEST(TripleProduct, SlackOfTheThirdVectorIsCovered) {
  Random random(2);
  double worst = 0;
  for (int i = 0; i < 3000; ++i) {
    const Points p = random_points(random, 1, Vec3::Zero());
    const double slack = std::ldexp(1.0, -static_cast<int>(random() % 50));
    // The worst shift is at a corner of the box that the slack allows.
    Exact shift[2];
    for (Exact& s : shift)
      for (mpq_class& x : s) x = (random() & 1) ? slack : -slack;
    const BernsteinCubic f = p.cubic(slack);
    const auto exact = p.exact(shift[0], shift[1]);
    for (std::size_t k = 0; k < 4; ++k) {
      const mpq_class off = abs(mpq_class(f.c[k]) - exact[k]);
      ASSERT_LE(off, mpq_class(f.error));
      worst = std::max(worst, mpq_class(off / mpq_class(f.error)).get_d());
    }
  }
  EXPECT_GT(worst, 0.3);
}

// The largest components of a and b are 1, and the three components of a x b sum to at most 6 in size.
// The code's factor 7 covers that.
TEST(TripleProduct, SlackAttainsSixTimesTheArea) {
  const MovingVector a{{1, -1, 1}, {1, -1, 1}}, b{{1, 1, -1}, {1, 1, -1}};
  const Vec3 n = a.start.cross(b.start);
  const double slack = 0.125;
  EXPECT_EQ(triple_product(a, b, {Vec3(1, 0, 0), Vec3(1, 0, 0)}, slack).error,
            72 * kUnitRoundoff + 7 * slack);
  EXPECT_LE(n.lpNorm<1>(), 6);
}

TEST(CertainSign, NeverContradictsTheExactSign) {
  Random random(3);
  for (const Family& family : kFamilies) {
    int certain = 0;
    for (int i = 0; i < 1000; ++i) {
      const Points p = family.make(random);
      const int sign = certain_sign(p.cubic());
      certain += sign != 0;
      if (sign == 0) continue;
      const auto exact = p.exact();
      for (const mpq_class& t : {mpq_class(0), mpq_class(1, 7), mpq_class(1, 3), mpq_class(1, 2),
                                 mpq_class(5, 7), mpq_class(99, 100), mpq_class(1)})
        ASSERT_EQ(sgn(value(exact, t)), sign) << family.name;
    }
    const std::string name = family.name;
    if (name == "unit" || name == "far" || name == "huge" || name == "small" ||
        name == "at the small limit") {
      EXPECT_GT(certain, 10) << name;  // the claim is not empty
    }
  }
}

// Coefficients that are just beyond the error on either side still count as certain.
TEST(CertainSign, NeedsMoreThanTheError) {
  for (const int sign : {1, -1}) {
    for (int k = 0; k < 4; ++k) {
      BernsteinCubic f{{2.0 * sign, 2.0 * sign, 2.0 * sign, 2.0 * sign}, 0.5};
      EXPECT_EQ(certain_sign(f), sign);
      f.c[k] = std::nextafter(0.5, 1) * sign;
      EXPECT_EQ(certain_sign(f), sign);
      f.c[k] = 0.5 * sign;
      EXPECT_EQ(certain_sign(f), 0);
      f.c[k] = -2.0 * sign;
      EXPECT_EQ(certain_sign(f), 0);
    }
  }
}

// Rule error-bound: if something overflowed, nothing is known.
TEST(CertainSign, NotANumberAndInfinityAreNeverCertain) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  for (const double sign : {1.0, -1.0})
    for (int k = 0; k < 4; ++k) {
      BernsteinCubic f{{sign, sign, sign, sign}, 0.25};
      f.c[k] = nan;
      EXPECT_EQ(certain_sign(f), 0) << "coefficient " << k;
      f.c[k] = sign;
      f.error = nan;
      EXPECT_EQ(certain_sign(f), 0);
      f.error = inf;
      EXPECT_EQ(certain_sign(f), 0);
      for (double& c : f.c) c = sign * inf;
      EXPECT_EQ(certain_sign(f), 0);
    }
}

// Rule error-bound: the cross product overflows, although the product of all three sizes is moderate.
TEST(CertainSign, IsNotMisledByAnOverflowThatASmallThirdVectorHides) {
  const double big = 1.2e154, small = 1e-20;
  Random random(4);
  int unknown = 0;
  for (int i = 0; i < 20'000; ++i) {
    Points p;
    for (int v = 0; v < 3; ++v) {
      const double scale = v == 2 ? small : big;
      p.from_start[v] = p.from_end[v] = Vec3::Zero();
      p.to_start[v] = scale * any_vector(random);
      p.to_end[v] = scale * any_vector(random);
    }
    const BernsteinCubic f = p.cubic();
    unknown += !std::isfinite(f.error);
    const int sign = certain_sign(f);
    if (sign == 0) continue;
    for (const mpq_class& c : p.exact()) ASSERT_EQ(sgn(c), sign);
  }
  EXPECT_GT(unknown, 10'000);
}

TEST(TripleProduct, NotANumberInAnyInputLeavesNothingCertain) {
  Random random(5);
  for (int i = 0; i < 200; ++i) {
    const Points p = random_points(random, 1, Vec3::Zero());
    MovingVector v[3] = {p.vector(0), p.vector(1), p.vector(2)};
    for (MovingVector& vector : v)
      for (Vec3* end : {&vector.start, &vector.end})
        for (int k = 0; k < 3; ++k)
          for (const double bad :
               {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
            const double good = (*end)[k];
            (*end)[k] = bad;
            ASSERT_EQ(certain_sign(triple_product(v[0], v[1], v[2])), 0);
            (*end)[k] = good;
          }
  }
}

// Rule certain-sign: the points are coplanar throughout, in every way that makes the cubic zero.
TEST(CertainSign, ZeroCubicIsNotCertain) {
  const MovingVector x{{1, 0, 0}, {2, 0, 0}}, y{{0, 1, 0}, {0, 3, 0}}, z{{0, 0, 1}, {0, 0, 1}};
  const MovingVector zero{Vec3::Zero(), Vec3::Zero()};
  EXPECT_EQ(certain_sign(triple_product(x, y, z)), 1);
  EXPECT_EQ(certain_sign(triple_product(y, x, z)), -1);
  EXPECT_EQ(certain_sign(triple_product(x, y, x)), 0);
  EXPECT_EQ(certain_sign(triple_product(x, x, z)), 0);
  EXPECT_EQ(certain_sign(triple_product(zero, y, z)), 0);
  EXPECT_EQ(certain_sign(triple_product(x, y, zero)), 0);
  EXPECT_EQ(certain_sign(BernsteinCubic{{0, 0, 0, 0}, 0}), 0);
  // The cubic is zero at one end only.
  EXPECT_EQ(certain_sign(triple_product(x, y, {{0, 0, 0}, {0, 0, 1}})), 0);
  EXPECT_EQ(certain_sign(triple_product(x, y, {{0, 0, -1}, {0, 0, 0}})), 0);
}

TEST(BernsteinCubic, AtEvaluatesTheCubic) {
  Random random(6);
  for (int i = 0; i < 500; ++i) {
    const Points p = random_points(random, 1, Vec3::Zero());
    const double t = i < 2 ? i : uniform(random, 0, 1);
    EXPECT_NEAR(p.cubic().at(t), value(p.exact(), t).get_d(), 1e-13);
  }
}

}  // namespace
}  // namespace cscd
