#include "bench/compare/statistics/change_points.h"

#include <cmath>
#include <cstdio>
#include <gtest/gtest.h>
#include <random>

namespace cscd::bench {
namespace {

constexpr double kNoise = 0.02;

// A course around 1 whose points scatter by `noise`; `after` is the level from the point `step` on. One point
// in twenty is disturbed three times as much.
std::vector<CoursePoint> course(std::mt19937_64& random, std::size_t size, double noise, std::size_t step = 0,
                                double after = 1) {
  std::normal_distribution<double> normal;
  std::vector<CoursePoint> out;
  for (std::size_t i = 0; i < size; ++i) {
    const double scale = random() % 20 == 0 ? 3 * noise : noise;
    out.push_back({std::exp(scale * normal(random)) * (step > 0 && i >= step ? after : 1), noise / 2});
  }
  return out;
}

// The false-alarm rate: how many of a thousand courses without change are cut, whose noise is what the caller
// expects, and half as much more.
TEST(ChangePoints, RarelyCutACourseWithoutChange) {
  std::mt19937_64 random(34);
  for (const std::size_t size : {8u, 20u, 60u})
    for (const double noise : {kNoise, 1.5 * kNoise}) {
      int alarms = 0;
      for (int i = 0; i < 1000; ++i) alarms += !change_points(course(random, size, noise), kNoise).empty();
      std::printf("%zu points, noise %.3g: %d of 1000 courses without change are cut\n", size, noise, alarms);
      EXPECT_LE(alarms, 50) << size << " points, noise " << noise;
    }
}

TEST(ChangePoints, FindAStepWhereItIs) {
  std::mt19937_64 random(35);
  int found = 0;
  for (int i = 0; i < 200; ++i) {
    const auto points = change_points(course(random, 20, kNoise, 12, 0.85), kNoise);
    found += points.size() == 1 && points[0].first == 12 && std::abs(points[0].ratio - 0.85) < 0.05;
  }
  std::printf("a step of 15 %% in 20 points: found where it is in %d of 200\n", found);
  EXPECT_GE(found, 180);
}

TEST(ChangePoints, FindSeveralSteps) {
  std::vector<CoursePoint> points;
  for (const double level : {1.0, 0.5, 0.5, 0.8, 0.8, 0.8}) points.push_back({level, 0.01});
  const auto found = change_points(points, kNoise);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].first, 1u);
  EXPECT_NEAR(found[0].ratio, 0.5, 1e-9);
  EXPECT_EQ(found[1].first, 3u);
  EXPECT_NEAR(found[1].ratio, 1.6, 1e-9);
}

TEST(ChangePoints, SayNothingOfOnePoint) {
  EXPECT_TRUE(change_points({}, kNoise).empty());
  EXPECT_TRUE(change_points(std::vector<CoursePoint>{{1, 0}}, kNoise).empty());
}

}  // namespace
}  // namespace cscd::bench
