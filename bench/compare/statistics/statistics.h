#pragma once

#include <cstddef>
#include <span>

// Summaries of repeated measurements. Medians, because a shared machine disturbs in one direction; intervals
// by the percentile bootstrap (Efron 1979), because nothing is known about the shape of the noise. Seeds are
// fixed: the same samples give the same interval.
namespace cscd::bench {

double mean(std::span<const double> samples);    // of at least one
double median(std::span<const double> samples);  // of at least one
// Linear between order statistics (type 7 of Hyndman and Fan 1996); `share` in [0, 1].
double quantile(std::span<const double> samples, double share);
double quantile_of_sorted(std::span<const double> sorted, double share);

struct Estimate {
  double value, low, high;  // the statistic of the samples, and its 95 % interval
};

Estimate bootstrap_median(std::span<const double> samples);

// The median of a over the median of b, where a[i] and b[i] come from the same repetition: both are resampled
// together, so that drift common to a pair cancels. Sizes are equal.
Estimate bootstrap_ratio_of_medians(std::span<const double> a, std::span<const double> b);
// The same of the means: what all of a took over what all of b took, where samples are of unequal work.
Estimate bootstrap_ratio_of_means(std::span<const double> a, std::span<const double> b);

}  // namespace cscd::bench
