#include "bench/compare/statistics/process_ratio.h"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <random>

#include "bench/compare/statistics/statistics.h"

namespace cscd::bench {
namespace {

constexpr int kRatioResamples = 1000, kNoiseResamples = 300;
constexpr std::size_t kDrawsOfAProcess = 16;
constexpr std::uint64_t kRatioSeed = 2013;
constexpr double kDecile = 0.1;

// The mean of the middle half. It ignores the quarter of the pairs that a disturbance slowed most, as the
// median does, and uses more of the others.
double middle_mean(std::vector<double>& values) {
  const auto cut = static_cast<std::ptrdiff_t>(values.size() / 4);
  const auto begin = values.begin() + cut, end = values.end() - cut;
  std::nth_element(values.begin(), begin, values.end());
  if (end != values.end()) std::nth_element(begin, end, values.end());
  double sum = 0;
  for (auto value = begin; value != end; ++value) sum += *value;
  return sum / static_cast<double>(end - begin);
}

// A place in a list of fewer than 2^32, without the division of `%`.
std::size_t any_place(std::size_t size, std::mt19937_64& random) {
  return static_cast<std::size_t>(((random() >> 32) * size) >> 32);
}

// A process and what becomes of it where its repetitions are drawn anew, as logarithms.
class Draws {
 public:
  Draws(const ProcessTimes& times, std::mt19937_64& random) {
    ProcessTimes drawn(times.size());
    for (std::size_t i = 0; i < kDrawsOfAProcess; ++i) {
      for (std::vector<double>& repetition : drawn) repetition = times[any_place(times.size(), random)];
      logs_.push_back(std::log(process_time(drawn)));
    }
  }
  double any(std::mt19937_64& random) const { return logs_[any_place(logs_.size(), random)]; }

 private:
  std::vector<double> logs_;
};

}  // namespace

double process_time(const ProcessTimes& times) {
  assert(!times.empty() && !times.front().empty());
  const std::size_t intervals = times.front().size();
  std::vector<double> column(times.size());
  double sum = 0;
  for (std::size_t i = 0; i < intervals; ++i) {
    for (std::size_t r = 0; r < times.size(); ++r) column[r] = times[r][i];
    std::sort(column.begin(), column.end());
    sum += quantile_of_sorted(column, kDecile);
  }
  return sum / static_cast<double>(intervals);
}

double log_process_ratio(std::span<const ProcessPair> pairs) {
  assert(!pairs.empty());
  std::vector<double> logs;
  for (const ProcessPair& pair : pairs)
    logs.push_back(std::log(process_time(pair.after) / process_time(pair.before)));
  return middle_mean(logs);
}

double standard_deviation(std::span<const double> values) {
  const double centre = mean(values);
  double squares = 0;
  for (const double value : values) squares += (value - centre) * (value - centre);
  return std::sqrt(squares / static_cast<double>(values.size()));
}

double interval_half_width(double miss, std::size_t samples) {
  assert(samples > 1);
  const boost::math::students_t t(static_cast<double>(samples - 1));
  return boost::math::quantile(boost::math::complement(t, miss / 2));
}

ProcessRatio bootstrap_process_ratio(std::span<const ProcessPair> pairs) {
  std::mt19937_64 random(kRatioSeed);
  std::vector<Draws> before, after;
  for (const ProcessPair& pair : pairs) {
    before.emplace_back(pair.before, random);
    after.emplace_back(pair.after, random);
  }
  ProcessRatio out;
  out.log_ratio = log_process_ratio(pairs);
  std::vector<double> logs(pairs.size()), noise;
  for (int i = 0; i < kRatioResamples; ++i) {
    for (double& log : logs) {
      const std::size_t pair = any_place(pairs.size(), random);
      log = after[pair].any(random) - before[pair].any(random);
    }
    out.resampled.push_back(middle_mean(logs));
  }
  for (int i = 0; i < kNoiseResamples; ++i) {
    for (double& log : logs)
      log = before[any_place(pairs.size(), random)].any(random) -
            before[any_place(pairs.size(), random)].any(random);
    noise.push_back(std::abs(middle_mean(logs)));
  }
  // The bootstrap's variance is that of n samples around their own mean, too small by (n - 1) / n.
  const auto n = static_cast<double>(pairs.size());
  out.standard_error = standard_deviation(out.resampled) * std::sqrt(n / std::max(n - 1, 1.0));
  out.noise_floor = quantile(noise, 0.95);
  return out;
}

}  // namespace cscd::bench
