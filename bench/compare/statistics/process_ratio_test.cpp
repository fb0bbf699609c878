#include "bench/compare/statistics/process_ratio.h"

#include <cmath>
#include <gtest/gtest.h>
#include <random>

namespace cscd::bench {
namespace {

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

}  // namespace
}  // namespace cscd::bench
