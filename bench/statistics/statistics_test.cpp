#include "bench/statistics/statistics.h"

#include <cmath>
#include <cstdio>
#include <gtest/gtest.h>
#include <random>
#include <vector>

namespace cscd::bench {

namespace {

TEST(Statistics, QuantilesOfKnownSamples) {
  const std::vector<double> odd = {5, 1, 3}, even = {4, 1, 3, 2}, one = {7};
  EXPECT_EQ(median(odd), 3);
  EXPECT_EQ(median(even), 2.5);
  EXPECT_EQ(median(one), 7);
  EXPECT_EQ(mean(even), 2.5);
  EXPECT_EQ(quantile(even, 0), 1);
  EXPECT_EQ(quantile(even, 1), 4);
  EXPECT_DOUBLE_EQ(quantile(even, 0.25), 1.75);
  EXPECT_DOUBLE_EQ(quantile(even, 0.9), 3.7);
}

TEST(Statistics, SamplesWithoutSpreadHaveAnIntervalWithoutWidth) {
  const std::vector<double> a(5, 6.0), b(5, 2.0);
  const Estimate estimate = bootstrap_median(a), ratio = bootstrap_ratio_of_medians(a, b);
  EXPECT_EQ(estimate.low, 6);
  EXPECT_EQ(estimate.high, 6);
  EXPECT_EQ(ratio.value, 3);
  EXPECT_EQ(ratio.low, 3);
  EXPECT_EQ(ratio.high, 3);
  // All over all, where medians would see neither of the large blocks: (1 + 1 + 10) / (2 + 2 + 2).
  EXPECT_EQ(bootstrap_ratio_of_means(std::vector{1.0, 1.0, 10.0}, std::vector{2.0, 2.0, 2.0}).value, 2);
}

// With three samples, all resamples can be listed: the median is the smallest with probability 7/27, which
// exceeds 2.5 %, so the interval reaches from the smallest to the largest sample.
TEST(Statistics, IntervalOfThreeSamplesReachesFromSmallestToLargest) {
  const std::vector<double> samples = {10, 2, 5};
  const Estimate estimate = bootstrap_median(samples);
  EXPECT_EQ(estimate.value, 5);
  EXPECT_EQ(estimate.low, 2);
  EXPECT_EQ(estimate.high, 10);
}

TEST(Statistics, SameSamplesSameInterval) {
  const std::vector<double> samples = {1, 4, 2, 8, 5, 7};
  const Estimate first = bootstrap_median(samples), second = bootstrap_median(samples);
  EXPECT_EQ(first.low, second.low);
  EXPECT_EQ(first.high, second.high);
}

// The interval has to hold the true median in about 95 of 100 experiments; fewer than 85 in 100 or all of 400
// would be the mark of a wrong quantile.
TEST(Statistics, IntervalCoversTheTrueMedian) {
  std::mt19937_64 random(7);
  std::exponential_distribution<double> noise(1);
  const int experiments = 400;
  int covered = 0;
  for (int i = 0; i < experiments; ++i) {
    std::vector<double> samples(25);
    for (double& sample : samples) sample = noise(random);
    const Estimate estimate = bootstrap_median(samples);
    covered += estimate.low <= std::log(2.0) && std::log(2.0) <= estimate.high;
  }
  EXPECT_GE(covered, experiments * 85 / 100);
  EXPECT_LT(covered, experiments);
}

// A slow spell that hits both of a pair must not widen the interval of their ratio.
TEST(Statistics, DriftCommonToAPairCancels) {
  const std::vector<double> drift = {1, 1.5, 3, 1.2, 2};
  std::vector<double> a, b;
  for (const double d : drift) {
    a.push_back(8 * d);
    b.push_back(2 * d);
  }
  const Estimate ratio = bootstrap_ratio_of_medians(a, b);
  EXPECT_DOUBLE_EQ(ratio.low, 4);
  EXPECT_DOUBLE_EQ(ratio.high, 4);
  const Estimate of_means = bootstrap_ratio_of_means(a, b);
  EXPECT_DOUBLE_EQ(of_means.low, 4);
  EXPECT_DOUBLE_EQ(of_means.high, 4);
  EXPECT_LT(bootstrap_median(a).low, bootstrap_median(a).high);
}

// Processes whose level varies by `between`, and whose repetitions vary by `within` around it.
std::vector<ProcessPair> pairs_of(std::mt19937_64& random, std::size_t count, double ratio, double between,
                                  double within) {
  std::normal_distribution<double> normal;
  const auto process = [&](double level) {
    level *= std::exp(between * normal(random));
    ProcessTimes times(5, std::vector<double>(2));
    for (auto& repetition : times)
      for (double& ms : repetition) ms = level * std::exp(within * std::abs(normal(random)));
    return times;
  };
  std::vector<ProcessPair> pairs;
  for (std::size_t i = 0; i < count; ++i) {
    ProcessTimes before = process(1);
    pairs.push_back({std::move(before), process(ratio)});
  }
  return pairs;
}

TEST(ProcessRatio, IsExactWithoutNoise) {
  std::mt19937_64 random(1);
  const ProcessRatio ratio = bootstrap_process_ratio(pairs_of(random, 8, 1.25, 0, 0));
  EXPECT_NEAR(ratio.log_ratio, std::log(1.25), 1e-12);
  EXPECT_NEAR(ratio.standard_error, 0, 1e-12);
  EXPECT_NEAR(ratio.noise_floor, 0, 1e-12);
}

TEST(ProcessRatio, TakesTheLowestDecileOfEachInterval) {
  ProcessTimes times(11, std::vector<double>(2));
  for (std::size_t r = 0; r < times.size(); ++r)
    times[r] = {10.0 - static_cast<double>(r), 100.0 + static_cast<double>(r)};
  EXPECT_DOUBLE_EQ(process_time(times), (1 + 101) / 2.0);
}

// Spells that slow a few processes by half change nothing much.
TEST(ProcessRatio, IgnoresAFewDisturbedProcesses) {
  std::mt19937_64 random(2);
  std::vector<ProcessPair> pairs = pairs_of(random, 40, 1, 0.01, 0.01);
  for (std::size_t i = 0; i < 8; ++i)
    for (auto& repetition : pairs[i].after)
      for (double& ms : repetition) ms *= 1.5;
  EXPECT_NEAR(log_process_ratio(pairs), 0, 0.01);
}

// What repetitions say of each other is not what processes do: with processes that differ by 5 % and
// repetitions that hardly do, 95 % intervals over processes have to hold the true ratio in about 95 of 100.
TEST(ProcessRatio, IntervalsOverProcessesHoldTheTrueRatio) {
  std::mt19937_64 random(3);
  int held = 0;
  for (int i = 0; i < 200; ++i) {
    const ProcessRatio ratio = bootstrap_process_ratio(pairs_of(random, 20, 1.1, 0.05, 0.002));
    held += std::abs(ratio.log_ratio - std::log(1.1)) < interval_half_width(0.05, 20) * ratio.standard_error;
  }
  EXPECT_GE(held, 180);
  EXPECT_LT(held, 200);
}

TEST(ProcessRatio, HalfWidthIsStudents) {
  EXPECT_NEAR(interval_half_width(0.05, 6), 2.5706, 1e-4);  // from a table of t with 5 degrees of freedom
  EXPECT_NEAR(interval_half_width(0.01, 31), 2.7500, 1e-4);
}

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
