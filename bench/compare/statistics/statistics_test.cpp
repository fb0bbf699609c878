#include "bench/compare/statistics/statistics.h"

#include <cmath>
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

}  // namespace
}  // namespace cscd::bench
