#include "core/geometry/kdop.h"

#include <bit>
#include <cfloat>
#include <cmath>
#include <gtest/gtest.h>
#include <random>
#include <vector>

#include "core/geometry/test_exact_kdop.h"

namespace cscd {
namespace {

using test::at_most;
using test::contains;
using test::projections;

constexpr float kInf = std::numeric_limits<float>::infinity();

std::vector<Vec3> assorted_points() {
  std::vector<Vec3> points = {{0, 0, 0},
                              {-0.0, 0, -0.0},
                              {DBL_MAX, DBL_MAX, -DBL_MAX},
                              {-DBL_MAX, 1e308, 1e308},
                              {DBL_TRUE_MIN, -DBL_TRUE_MIN, 0},
                              {1, 0x1p-60, -0x1p-60},
                              {FLT_MAX, FLT_MAX, 1},
                              {1 + 0x1p-24, 1 + 0x1p-23, 0x1p-53}};
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (const double scale : {1.0, 1e-3, 1e6, 1e-42, 1e-310, 1e37, 1e39, 1e300})
    for (int i = 0; i < 300; ++i)
      points.push_back(scale * Vec3(unit(random), unit(random), unit(random)) +
                       (i % 3 == 0 ? Vec3(1e4 * scale, 0, 0) : Vec3(0, 0, 0)));
  // Coordinates that are floats: most projections lie on the grid of floats or very near to it.
  for (int i = 0; i < 300; ++i)
    points.push_back(Vec3(static_cast<float>(unit(random)), std::ldexp(static_cast<float>(unit(random)), -20),
                          static_cast<float>(unit(random))));
  return points;
}

// Rule outward-rounding.
TEST(Kdop, EveryBoundIsTheTightestFloatOutwardOfTheExactProjection) {
  for (const Vec3& p : assorted_points()) {
    const Kdop16 volume = kdop_of(p);
    const auto exact = projections(p);
    for (std::size_t k = 0; k < 16; ++k) {
      ASSERT_TRUE(at_most(volume.at_least[k], exact[k])) << p.transpose() << ", bound " << k;
      ASSERT_FALSE(at_most(std::nextafter(volume.at_least[k], kInf), exact[k]))
          << p.transpose() << ", bound " << k;
    }
  }
}

TEST(Kdop, ABoxIsItsFirstThreeDirections) {
  for (const Vec3& p : assorted_points()) {
    const Kdop16 volume = kdop_of(p);
    const Aabb box = aabb_of(p);
    for (std::size_t k = 0; k < 3; ++k) {
      ASSERT_EQ(box.at_least[k], volume.at_least[k]);
      ASSERT_EQ(box.at_least[4 + k], volume.at_least[8 + k]);
    }
    ASSERT_TRUE(overlap(box, box));
  }
  const Aabb box = aabb_of(MovingPoint{{0, 0, 0}, {1, 1, 1}});
  for (int axis = 0; axis < 3; ++axis) {
    Vec3 beside(0.5, 0.5, 0.5);
    EXPECT_TRUE(overlap(box, aabb_of(beside)));
    for (const double x : {-0.5, 1.5}) {
      beside[axis] = x;
      EXPECT_FALSE(overlap(box, aabb_of(beside)));
    }
  }
}

// Saboteur: if any single bound is drawn in by one unit in the last place, the test notices.
TEST(Kdop, AnyBoundDrawnInByOneUlpLosesThePath) {
  const std::vector<Vec3> points = assorted_points();
  for (std::size_t i = 1; i < points.size(); ++i) {
    const MovingPoint path{points[i - 1], points[i]};
    const Kdop16 volume = kdop_of(path);
    ASSERT_TRUE(contains(volume, path));
    for (std::size_t k = 0; k < 16; ++k) {
      Kdop16 drawn_in = volume;
      drawn_in.at_least[k] = std::nextafter(drawn_in.at_least[k], kInf);
      ASSERT_FALSE(contains(drawn_in, path)) << "bound " << k;
    }
  }
}

TEST(Kdop, ContainsThePathInBetween) {
  const std::vector<Vec3> points = assorted_points();
  for (std::size_t i = 1; i < points.size(); ++i) {
    const Kdop16 volume = kdop_of(MovingPoint{points[i - 1], points[i]});
    const auto start = projections(points[i - 1]), end = projections(points[i]);
    for (const mpq_class& t : {mpq_class(1, 3), mpq_class(1, 2), mpq_class(6, 7)})
      for (std::size_t k = 0; k < 16; ++k)
        ASSERT_TRUE(at_most(volume.at_least[k], (1 - t) * start[k] + t * end[k]));
  }
}

TEST(Kdop, UnitedIsTheSmallestThatContainsBoth) {
  const std::vector<Vec3> points = assorted_points();
  for (std::size_t i = 1; i < points.size(); ++i) {
    const Kdop16 a = kdop_of(points[i - 1]), b = kdop_of(points[i]), both = united(a, b);
    for (std::size_t k = 0; k < 16; ++k) ASSERT_EQ(both.at_least[k], std::min(a.at_least[k], b.at_least[k]));
  }
}

// Returns whether two volumes overlap along all directions, decided in rational arithmetic.
bool overlap_exactly(const Kdop16& a, const Kdop16& b) {
  for (std::size_t k = 0; k < 8; ++k) {
    const auto apart = [&](const Kdop16& low, const Kdop16& high) {  // does `low` end before `high` begins?
      const float begins = high.at_least[k], ends = low.at_least[8 + k];
      if (begins == -kInf || ends == -kInf) return false;
      return mpq_class(begins) + mpq_class(ends) > 0;
    };
    if (apart(a, b) || apart(b, a)) return false;
  }
  return true;
}

TEST(Kdop, OverlapIsExactOnStoredBounds) {
  std::mt19937_64 random(2);
  std::uniform_int_distribution<int> grid(-3, 3);
  int touching = 0, apart = 0;
  for (int i = 0; i < 20'000; ++i) {
    const auto point = [&] { return Vec3(grid(random), grid(random), grid(random)); };
    Kdop16 a = kdop_of(MovingPoint{point(), point()}), b = kdop_of(MovingPoint{point(), point()});
    if (i % 4 == 1) a.at_least[random() % 16] = -kInf;
    if (i % 4 == 2) {
      float& bound = b.at_least[random() % 16];
      bound = std::nextafter(bound, random() & 1 ? kInf : -kInf);
    }
    ASSERT_EQ(overlap(a, b), overlap_exactly(a, b));
    ASSERT_EQ(overlap(b, a), overlap_exactly(a, b));
    apart += !overlap(a, b);
    for (std::size_t k = 0; k < 8; ++k) touching += overlap(a, b) && a.at_least[k] == -b.at_least[8 + k];
  }
  EXPECT_GT(touching, 1000);
  EXPECT_GT(apart, 1000);
}

TEST(Kdop, EachDirectionAloneSeparates) {
  const Kdop16 unit = kdop_of(MovingPoint{{-1, -1, -1}, {1, 1, 1}});
  for (std::size_t k = 0; k < 16; ++k) {
    Kdop16 everything;
    std::fill(std::begin(everything.at_least), std::end(everything.at_least), -kInf);
    const float end = -unit.at_least[(k + 8) % 16];  // where the unit volume ends along direction k
    everything.at_least[k] = end;
    EXPECT_TRUE(overlap(unit, everything)) << k;  // touching counts
    EXPECT_TRUE(overlap(everything, unit)) << k;
    everything.at_least[k] = std::nextafter(end, kInf);
    EXPECT_FALSE(overlap(unit, everything)) << k;
    EXPECT_FALSE(overlap(everything, unit)) << k;
  }
}

// Beyond the range of float a bound says nothing and must not separate volumes.
TEST(Kdop, VolumesBeyondFloatStillOverlapThemselves) {
  for (const double far : {1e39, 1e300, DBL_MAX}) {
    const Kdop16 a = kdop_of(Vec3(far, far, -far)), b = kdop_of(Vec3(-far, far, far));
    EXPECT_TRUE(overlap(a, a));
    EXPECT_FALSE(overlap(a, b));
  }
}

}  // namespace
}  // namespace cscd
