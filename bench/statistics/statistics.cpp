#include "bench/statistics/statistics.h"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <random>
#include <vector>

namespace cscd::bench {

namespace {

constexpr int kResamples = 2000;
constexpr std::uint64_t kSeed = 1979;

// `statistic` takes the indices of one resample, with repetition.
template <class Statistic>
Estimate bootstrap(std::size_t size, const Statistic& statistic) {
  std::vector<std::size_t> indices(size);
  std::iota(indices.begin(), indices.end(), std::size_t{0});
  const double value = statistic(indices);

  std::mt19937_64 random(kSeed);
  std::vector<double> resampled;
  resampled.reserve(kResamples);
  for (int i = 0; i < kResamples; ++i) {
    for (std::size_t& index : indices) index = random() % size;
    resampled.push_back(statistic(indices));
  }
  return {value, quantile(resampled, 0.025), quantile(resampled, 0.975)};
}

double median_of(std::span<const double> samples, std::span<const std::size_t> indices) {
  std::vector<double> chosen;
  chosen.reserve(indices.size());
  for (const std::size_t index : indices) chosen.push_back(samples[index]);
  return median(chosen);
}

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

// The standard deviation of a normal distribution over the median absolute difference of two of its samples.
constexpr double kOverMedianDifference = 1.0483;
constexpr std::size_t kLeastForDifferences = 5, kLeastInnerLevel = 2;

// Weighted sums over prefixes of a course, so that a level's cost is had at once.
class Costs {
 public:
  Costs(std::span<const CoursePoint> course, double noise) : sums_(1) {
    for (const CoursePoint& point : course) {
      const double error = std::max(point.standard_error, noise), weight = 1 / (error * error);
      const double y = std::log(point.value);
      const Sums& last = sums_.back();
      sums_.push_back({last.weight + weight, last.first + weight * y, last.second + weight * y * y});
    }
  }
  // Of the points from `begin` up to `end`, which is not among them.
  double cost(std::size_t begin, std::size_t end) const {
    const double first = sums_[end].first - sums_[begin].first;
    return sums_[end].second - sums_[begin].second - first * first / weight(begin, end);
  }
  double level(std::size_t begin, std::size_t end) const {
    return (sums_[end].first - sums_[begin].first) / weight(begin, end);
  }

 private:
  struct Sums {
    double weight = 0, first = 0, second = 0;
  };
  double weight(std::size_t begin, std::size_t end) const { return sums_[end].weight - sums_[begin].weight; }
  std::vector<Sums> sums_;
};

double noise_between(std::span<const CoursePoint> course, double least) {
  if (course.size() < kLeastForDifferences) return least;
  std::vector<double> differences;
  for (std::size_t i = 1; i < course.size(); ++i)
    differences.push_back(std::abs(std::log(course[i].value / course[i - 1].value)));
  return std::max(least, kOverMedianDifference * median(differences));
}

}  // namespace

double mean(std::span<const double> samples) {
  assert(!samples.empty());
  return std::accumulate(samples.begin(), samples.end(), 0.0) / static_cast<double>(samples.size());
}

double median(std::span<const double> samples) {
  return quantile(samples, 0.5);
}

double quantile(std::span<const double> samples, double share) {
  std::vector<double> sorted(samples.begin(), samples.end());
  std::ranges::sort(sorted);
  return quantile_of_sorted(sorted, share);
}

double quantile_of_sorted(std::span<const double> sorted, double share) {
  assert(!sorted.empty() && share >= 0 && share <= 1);
  const double place = share * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (place - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

Estimate bootstrap_median(std::span<const double> samples) {
  return bootstrap(samples.size(),
                   [&](const std::vector<std::size_t>& indices) { return median_of(samples, indices); });
}

Estimate bootstrap_ratio_of_medians(std::span<const double> a, std::span<const double> b) {
  assert(a.size() == b.size());
  return bootstrap(a.size(), [&](const std::vector<std::size_t>& indices) {
    return median_of(a, indices) / median_of(b, indices);
  });
}

Estimate bootstrap_ratio_of_means(std::span<const double> a, std::span<const double> b) {
  assert(a.size() == b.size());
  return bootstrap(a.size(), [&](const std::vector<std::size_t>& indices) {
    double sum_a = 0, sum_b = 0;
    for (const std::size_t index : indices) sum_a += a[index], sum_b += b[index];
    return sum_a / sum_b;
  });
}

double process_time(const ProcessTimes& times) {
  assert(!times.empty() && !times.front().empty());
  const std::size_t intervals = times.front().size();
  std::vector<double> column(times.size());
  double sum = 0;
  for (std::size_t i = 0; i < intervals; ++i) {
    for (std::size_t r = 0; r < times.size(); ++r) column[r] = times[r][i];
    std::ranges::sort(column);
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

std::vector<ChangePoint> change_points(std::span<const CoursePoint> course, double least_noise) {
  const std::size_t n = course.size();
  if (n < 2) return {};
  const Costs costs(course, noise_between(course, least_noise));
  const double penalty = 12 + 2 * std::log(static_cast<double>(n));
  std::vector<double> best(n + 1, std::numeric_limits<double>::infinity());
  std::vector<std::size_t> begin_of(n + 1, 0);
  best[0] = -penalty;
  for (std::size_t end = 1; end <= n; ++end)
    for (std::size_t begin = 0; begin < end; ++begin) {
      const bool is_inner = begin > 0 && end < n;
      if (is_inner && end - begin < kLeastInnerLevel) continue;
      if (const double cost = best[begin] + penalty + costs.cost(begin, end); cost < best[end]) {
        best[end] = cost;
        begin_of[end] = begin;
      }
    }
  std::vector<std::size_t> cuts = {n};
  while (cuts.back() > 0) cuts.push_back(begin_of[cuts.back()]);
  std::ranges::reverse(cuts);
  std::vector<ChangePoint> out;
  for (std::size_t i = 1; i + 1 < cuts.size(); ++i)
    out.push_back({cuts[i], std::exp(costs.level(cuts[i], cuts[i + 1]) - costs.level(cuts[i - 1], cuts[i]))});
  return out;
}

}  // namespace cscd::bench
