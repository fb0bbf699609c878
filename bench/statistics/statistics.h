#pragma once

#include <cstddef>
#include <span>
#include <vector>

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

// How much slower one program is than another, from processes that ran in pairs, one after the other. A
// process places its memory anew, and with that moves all its times together, so repetitions within a process
// say little about the next process. Processes are therefore resampled first and repetitions within them
// (Kalibera and Jones 2013).
//
// What one process took: [repetition][interval], positive. What stands for the process is the mean over the
// intervals of the lowest decile over the repetitions: on a shared machine disturbances only slow, and the
// minimum alone would depend on how many repetitions there are.
using ProcessTimes = std::vector<std::vector<double>>;

struct ProcessPair {
  ProcessTimes before, after;
};

double process_time(const ProcessTimes& times);

struct ProcessRatio {
  double log_ratio = 0;       // of after over before
  double standard_error = 0;  // of that logarithm, over resamples
  // How far two sets of as many processes differ that are both drawn from the old program's: the absolute
  // logarithm of their ratio that 95 of 100 such draws stay under. That is what the machine's noise does with
  // no change at all.
  double noise_floor = 0;
  // The logarithm on every resample. Lists of several scenes can be added.
  std::vector<double> resampled;
};

// Returns the ratio over all pairs: the mean logarithm of the middle half of the pairs' ratios. Needs a pair.
ProcessRatio bootstrap_process_ratio(std::span<const ProcessPair> pairs);

// The same ratio's logarithm alone.
double log_process_ratio(std::span<const ProcessPair> pairs);

double standard_deviation(std::span<const double> values);

// Half the width of an interval, in standard errors, that misses the true value with probability `miss`: the
// quantile of Student's t with one degree of freedom less than there are samples. At least two samples.
double interval_half_width(double miss, std::size_t samples);

// One point of a course of measurements.
struct CoursePoint {
  double value;           // positive
  double standard_error;  // of the value's logarithm, as far as the measurement itself tells; may be 0
};

// Where a course changes its level.
struct ChangePoint {
  std::size_t first;  // the first point of the new level
  double ratio;       // the new level over the old one
};

// Finds the changes of level by penalised least squares: of all ways to cut the course into levels, the one
// with the least sum of squared deviations of logarithms, in units of their noise, plus a penalty a cut. The
// optimum is exact (optimal partitioning: Jackson et al. 2005; PELT of Killick et al. 2012 prunes the same
// recursion, which so short a course does not need). A point's noise is the largest of its own standard
// error, `least_noise`, and what neighbouring points differ by (median absolute difference, so that a few
// steps do not widen it). One point between two levels is an outlier and is ignored; the first and the last
// point may be levels of their own. The penalty is 12 + 2 log(n): statistics_test.cpp measures how often a
// course without change is cut.
std::vector<ChangePoint> change_points(std::span<const CoursePoint> course, double least_noise);

}  // namespace cscd::bench
