#include "bench/compare/statistics/change_points.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bench/compare/statistics/statistics.h"

namespace cscd::bench {
namespace {

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
  std::reverse(cuts.begin(), cuts.end());
  std::vector<ChangePoint> out;
  for (std::size_t i = 1; i + 1 < cuts.size(); ++i)
    out.push_back({cuts[i], std::exp(costs.level(cuts[i], cuts[i + 1]) - costs.level(cuts[i - 1], cuts[i]))});
  return out;
}

}  // namespace cscd::bench
