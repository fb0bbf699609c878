#include "bench/compare/statistics/statistics.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>
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
  std::sort(sorted.begin(), sorted.end());
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

}  // namespace cscd::bench
