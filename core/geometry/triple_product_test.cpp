#include <algorithm>
#include <cfloat>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <random>
#include <vector>

#include "core/geometry/triple_product16.h"
#include "core/geometry/triple_product_lanes.h"

namespace cscd {

namespace {

// If all third vectors are equally long, both ways agree whether all cubics certainly are positive,
// whichever coefficient fails, be it by its sign or by the bound. Mutations: one of the four
// coefficients is left out; the middle two are compared with the bound of the outer ones; the reach is a
// hundredth of what it should be.
TEST(TripleProduct16, AllArePositiveWhereEachIs) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> digits(-1, 1);
  std::size_t all = 0, not_all[4] = {};
  for (int round = 0; round < 400000; ++round) {
    const float error = round % 2 == 0 ? 0x1p-22F : 0.002F, reach = 2;
    VectorLanes16 a, b, c;
    for (VectorLanes16* v : {&a, &b, &c})
      for (auto& end : v->at)
        for (Float16& component : end) {
          const float middle = digits(random);
          for (std::size_t l = 0; l < kLanes16; ++l) component[l] = middle + 0.02F * digits(random);
        }
    const float sign = digits(random) < 0 ? -1.0F : 1.0F;
    c.at[round & 1][round % 3] = all_lanes(sign * reach);
    Float16 normal[3][3], coefficient[4];
    cross(a, b, normal);
    coefficients(normal, c, coefficient);
    const Rounding16 rounding = rounding_of(largest_component(a), largest_component(b), error);
    const TripleProducts16 products = bounded(coefficient, c, rounding, error);
    const bool each = products.positive() == 0xffff;
    EXPECT_EQ(all_positive(coefficient, rounding, reach + 2 * error), each);
    EXPECT_FALSE(all_positive(coefficient, rounding, std::numeric_limits<float>::infinity()));
    all += each;
    const auto holds = [&](int k) {
      return above(coefficient[k], k == 0 || k == 3 ? products.bound : products.bound3) == 0xffff;
    };
    int fails = 0, last = 0;
    for (int k = 0; k < 4; ++k)
      if (!holds(k)) ++fails, last = k;
    if (fails == 1) ++not_all[last];
  }
  EXPECT_GT(all, 1000u);
  for (const std::size_t alone : not_all) EXPECT_GT(alone, 100u);
}

// The bound is what the proof in the header needs, with all of its terms, and at most a fiftieth more.
// Mutations: an error counts once where it counts twice; a factor of the bound is dropped.
TEST(TripleProduct16, RuleErrorBoundTheBoundIsWhatTheProofSays) {
  const double u = 0x1p-24;
  for (const double a : {0.0, 1e-4, 0.75, 3.0})
    for (const double b : {0.0, 1e-4, 0.75, 3.0})
      for (const double c : {0.0, 1e-4, 0.75, 3.0})
        for (const double error : {0x1p-22, 1e-3, 0.5}) {
          VectorLanes16 third{};
          third.at[1][2] = all_lanes(static_cast<float>(-c));
          const auto d = static_cast<float>(error);
          const Rounding16 rounding =
              rounding_of(all_lanes(static_cast<float>(a)), all_lanes(static_cast<float>(b)), d);
          const TripleProducts16 products = bounded({}, third, rounding, d);
          const double longer_a = a + 2 * error, longer_b = b + 2 * error, longer_c = c + 2 * error;
          const double needed =
              12 * error * (longer_a * longer_b + longer_a * longer_c + longer_b * longer_c) +
              (19 + 6 * 8.1) * u * longer_a * longer_b * longer_c;
          const auto bound = static_cast<double>(products.bound[5]);
          EXPECT_GE(bound, needed);
          EXPECT_LE(bound, 1.02 * needed);
          EXPECT_GE(static_cast<double>(products.bound3[5]), 3 * needed);
        }
}

// Every combination of coefficients that are above their bounds, below them or uncertain. Mutations: one of
// the coefficients is left out, or compared with the bound of another; two of them have to hold together.
TEST(TripleProduct16, SignsAreThoseOfTheCoefficients) {
  for (int combination = 0; combination < 81; ++combination) {
    TripleProducts16 products{{}, all_lanes(1), all_lanes(3), 0x5555};
    int sign[4], rest = combination;
    for (std::size_t k = 0; k < 4; ++k, rest /= 3) {
      sign[k] = rest % 3 - 1;
      const float bound = k == 0 || k == 3 ? 1 : 3;
      products.c[k] = all_lanes(sign[k] == 0 ? (combination % 2 == 0 ? bound : -bound)
                                             : 1.25F * bound * static_cast<float>(sign[k]));
    }
    const auto all = [&](int s) { return std::ranges::count(sign, s) == 4 ? 0x5555 : 0; };
    const bool mixed = std::ranges::count(sign, 1) > 0 && std::ranges::count(sign, -1) > 0;
    EXPECT_EQ(products.positive(), all(1)) << combination;
    EXPECT_EQ(products.negative(), all(-1)) << combination;
    EXPECT_EQ(products.mixed(), mixed ? 0x5555 : 0) << combination;
  }
}

// If sizes are so small that products underflow, nothing is certain by either way. Mutations: nothing is
// added to the bound for underflow; the area is not looked at.
TEST(TripleProduct16, OfWhatUnderflowsNothingIsCertain) {
  for (int down = 0; down < 40; ++down)
    for (int away = 0; away < 40; ++away) {
      const float size = std::ldexp(1.0F, -30 - down), far = std::ldexp(1.0F, away - 20);
      const auto all = [](float x, float y, float z) {
        VectorLanes16 v;
        for (auto& end : v.at) end[0] = all_lanes(x), end[1] = all_lanes(y), end[2] = all_lanes(z);
        return v;
      };
      const VectorLanes16 a = all(size, 0, 0), b = all(0, size, 0), c = all(0, 0, far);
      Float16 normal[3][3], coefficient[4];
      cross(a, b, normal);
      coefficients(normal, c, coefficient);
      const Rounding16 rounding = rounding_of(all_lanes(size), all_lanes(size), 1e-37F);
      const bool known = size * size > 1e-30F && size * size * far > 1e-30F;
      EXPECT_EQ(bounded(coefficient, c, rounding, 1e-37F).positive() == 0xffff, known);
      if (!known) {
        EXPECT_FALSE(all_positive(coefficient, rounding, far));
      }
    }
}

// Compares the signs of eight cubics at once with those of the scalar functions, on everything with which
// those are tested: all magnitudes, cancellation, zeros, overflow and NaN.
TEST(TripleProductLanes, SayWhatTheScalarTwinSays) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> unit(-1, 1);
  const double special[] = {0,
                            -0.0,
                            1,
                            -1,
                            1e-93,
                            1e99,
                            1e154,
                            1.3e154,
                            1e-20,
                            1e300,
                            DBL_MAX,
                            1e-310,
                            1e-140,
                            std::numeric_limits<double>::infinity(),
                            std::numeric_limits<double>::quiet_NaN()};
  int seen[3] = {};
  for (int round = 0; round < 20'000; ++round) {
    VectorLanes a, b, c;
    MovingVector vectors[3][kLanes];
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const Vec3 u(unit(random), unit(random), unit(random)), w(unit(random), unit(random), unit(random));
      for (std::size_t v = 0; v < 3; ++v) {
        const double scale = random() % 3 == 0 ? special[random() % std::size(special)] : 1;
        for (Vec3* end : {&vectors[v][lane].start, &vectors[v][lane].end}) {
          *end = random() % 4 == 0
                     ? Vec3(unit(random) * u + unit(random) * w)
                     : Vec3(u + (v == 0 ? 0.1 : 1.0) * Vec3(unit(random), unit(random), v * 2.0));
          *end *= scale;
          if (random() % 64 == 0)
            (*end)[static_cast<int>(random() % 3)] = special[random() % std::size(special)];
        }
      }
      VectorLanes* const lanes[3] = {&a, &b, &c};
      for (int v = 0; v < 3; ++v)
        for (int i = 0; i < 3; ++i) {
          lanes[v]->at[0][i][lane] = vectors[v][lane].start[i];
          lanes[v]->at[1][i][lane] = vectors[v][lane].end[i];
        }
    }
    const Sign8 signs = certain_signs(cross(a, b), c);
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const int expected = certain_sign(triple_product(vectors[0][lane], vectors[1][lane], vectors[2][lane]));
      ASSERT_EQ(signs[lane], expected) << "lane " << lane;
      ++seen[expected + 1];
    }
  }
  for (const int count : seen) EXPECT_GT(count, 1000);
}

// Vertices are gathered in their lanes, and vectors between them go from the second to the first. Mutations:
// an axis, an end or a lane is taken for another; the difference is turned round.
TEST(TripleProductLanes, VectorsAreThoseBetweenTheVerticesOfTheirLanes) {
  std::vector<Vec3> start, end;
  for (int v = 0; v < 2 * static_cast<int>(kLanes); ++v) {
    start.emplace_back(v, 100 + v * v, 10'000 + 3 * v);
    end.emplace_back(-v, 200 + v, 20'000 + v * v);
  }
  const Motion motion(start, end);
  VertexLanes from, to;
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    from.set(lane, VertexId{static_cast<std::int32_t>(lane)});
    to.set(lane, VertexId{static_cast<std::int32_t>(2 * kLanes - 1 - lane)});
  }
  const VectorLanes vectors = gather(motion, to) - gather(motion, from);
  for (std::size_t lane = 0; lane < kLanes; ++lane)
    for (int i = 0; i < 3; ++i) {
      EXPECT_EQ(vectors.at[0][i][lane], start[2 * kLanes - 1 - lane][i] - start[lane][i]);
      EXPECT_EQ(vectors.at[1][i][lane], end[2 * kLanes - 1 - lane][i] - end[lane][i]);
    }
}

}  // namespace

}  // namespace cscd
