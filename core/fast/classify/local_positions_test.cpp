#include "core/fast/classify/local_positions.h"

#include <gtest/gtest.h>
#include <limits>

#include "core/fast/prepare/test_body.h"
#include "core/radial/test_exact_orientation.h"

namespace cscd::fast {
namespace {

// Mutations: the error lacks its summand for rounding; the difference is taken in float.
TEST(LocalPositions, EveryCoordinateIsWithinItsError) {
  for (const auto& [origin, scale] : {std::pair<Vec3, double>{{0, 0, 0}, 1},
                                      {{1e7, -3e6, 123.456}, 1},
                                      {{0, 0, 0}, 1e-20},
                                      {{1e30, 0, 0}, 1e25}}) {
    const test::Body body(0.05, 2, origin, scale);
    LocalPositions local(body.start);
    local.update(body.motion());
    ASSERT_TRUE(local.known());
    // The scale is a power of two, so any coordinate shows it.
    const test::Exact3 first = test::exact(body.start[0]);
    double unit = 0;
    for (std::size_t v = 1; unit == 0; ++v)
      if (const double way = (body.start[v] - body.start[0]).x(); std::abs(way) > scale)
        unit = std::exp2(std::round(std::log2(static_cast<double>(local.records()[v].at[0]) / way)));
    for (std::size_t v = 0; v < body.start.size(); ++v)
      for (const auto& [points, at] : {std::pair{&body.start, 0U}, std::pair{&body.end, 4U}})
        for (std::size_t i = 0; i < 3; ++i) {
          const mpq_class exact = (test::exact((*points)[v])[i] - first[i]) * mpq_class(unit);
          const mpq_class off = exact - mpq_class(local.records()[v].at[at + i]);
          EXPECT_LE(abs(off), mpq_class(local.error()));
        }
    EXPECT_LT(local.error(), 4e-7F) << "the body is about one unit large";
  }
}

// Positions between the ends of an interval are rounded where they are computed (core/fast/fast_culler.cpp).
// Mutations: `off` is not scaled; it is left out; the largest coordinate is that of local units.
TEST(LocalPositions, KnowHowFarPositionsAreOff) {
  for (const auto& [origin, scale] :
       {std::pair<Vec3, double>{{1e10, -3e6, 123.456}, 1}, {{0, 0, 0}, 1e-20}, {{1e30, 0, 0}, 1e25}}) {
    const test::Body body(0.05, 2, origin, scale);
    LocalPositions local(body.start);
    local.update(body.motion());
    ASSERT_TRUE(local.known());
    const float error = local.error();
    const double largest = local.largest_in_scene(), off = 0x1p-50 * largest;
    std::vector<Vec3> between;
    for (std::size_t v = 0; v < body.start.size(); ++v) {
      EXPECT_LE(std::max(body.start[v].cwiseAbs().maxCoeff(), body.end[v].cwiseAbs().maxCoeff()), largest);
      between.push_back(body.start[v] + 0.421875 * (body.end[v] - body.start[v]));
      for (std::size_t i = 0; i < 3; ++i) {
        const mpq_class from = test::exact(body.start[v])[i], to = test::exact(body.end[v])[i];
        const mpq_class way = from + mpq_class(27, 64) * (to - from) - test::exact(between[v])[i];
        EXPECT_LE(abs(way), mpq_class(off));
      }
    }
    EXPECT_LT(largest, 4 * (origin.cwiseAbs().maxCoeff() + 20 * scale)) << "the bound is of use";
    local.update(Motion(body.start, between), ThreadPool(), off);
    ASSERT_TRUE(local.known());
    // The scale is a power of two, so it is known from a length.
    const double unit = static_cast<double>(local.records()[9].at[0]) / (body.start[9] - body.start[0]).x();
    EXPECT_GE(local.error(), 0.9 * off * unit);
    EXPECT_LE(local.error(), 1.1 * (off * unit + error));
  }
}

// Local coordinates name the points of the scene that they were made of. Mutation: an axis is taken for
// another.
TEST(LocalPositions, AreShownInTheSceneWhereTheyAre) {
  const test::Body body(0.05, 2, {100, -20, 3}, 8);
  LocalPositions local(body.start);
  local.update(body.motion());
  for (std::size_t v = 0; v < body.start.size(); ++v) {
    const float(&at)[8] = local.records()[v].at;
    const float start[3] = {at[0], at[1], at[2]}, end[3] = {at[4], at[5], at[6]};
    EXPECT_LT((local.in_scene(start, 0) - body.start[v]).norm(), 1e-4);
    EXPECT_LT((local.in_scene(end, 1) - body.end[v]).norm(), 1e-4);
  }
}

// Where the whole body flies, how its vertices lie to each other is known as well as where it stays, and
// points are still shown where they are. Mutations: the origin rests; it flies at the start too; the
// beginning of the interval takes the way of the whole; a vertex is placed by the other end's origin.
TEST(LocalPositions, FlyWithABodyThatFlies) {
  test::Body body(0.05, 2);
  for (Vec3& p : body.end) p += Vec3(3e5, -1e6, 7e5);
  LocalPositions local(body.start);
  for (const double last : {1.0, 0.25}) {
    last == 1 ? local.update(body.motion()) : local.update_beginning(body.motion(), last);
    ASSERT_TRUE(local.known());
    EXPECT_LT(local.error(), 4e-7F);
    const auto unit = static_cast<double>(local.records()[9].at[0]) / (body.start[9] - body.start[0]).x();
    for (std::size_t v = 0; v < body.start.size(); ++v) {
      const float(&at)[8] = local.records()[v].at;
      const float(&first)[8] = local.records()[0].at;
      const Vec3 end = body.start[v] + last * (body.end[v] - body.start[v]);
      const Vec3 first_end = body.start[0] + last * (body.end[0] - body.start[0]);
      for (Eigen::Index i = 0; i < 3; ++i) {
        const double apart = static_cast<double>(at[4 + i]) - static_cast<double>(first[4 + i]);
        EXPECT_NEAR(apart, unit * (end - first_end)[i], 2 * static_cast<double>(local.error()));
      }
      const float start[3] = {at[0], at[1], at[2]}, to[3] = {at[4], at[5], at[6]};
      EXPECT_LT((local.in_scene(start, 0) - body.start[v]).norm(), 1e-4);
      EXPECT_LT((local.in_scene(to, 1) - end).norm(), 1e-4);
    }
  }
}

TEST(LocalPositions, AMotionOutOfRangeIsNotKnown) {
  test::Body body(0, 1);
  LocalPositions local(body.start);
  body.end[7].y() = 1e200;
  local.update(body.motion());
  EXPECT_FALSE(local.known());
  body.end[7].y() = -1e308;
  body.start[0].y() = 1e308;
  local.update(body.motion());
  EXPECT_FALSE(local.known());
}

// The coordinate that is no number may be any of the three. Mutation: the maximum passes over NaN.
TEST(LocalPositions, WhatIsNoNumberIsNotKnown) {
  for (const Eigen::Index i : {0, 1, 2}) {
    test::Body body(0, 1);
    LocalPositions local(body.start);
    body.end[7][i] = std::numeric_limits<double>::quiet_NaN();
    local.update(body.motion());
    EXPECT_FALSE(local.known());
  }
}

}  // namespace
}  // namespace cscd::fast
