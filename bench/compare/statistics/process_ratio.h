#pragma once

#include <span>
#include <vector>

// How much slower one program is than another, from processes that ran in pairs, one after the other. A
// process places its memory anew, and with that moves all its times together, so repetitions within a process
// say little about the next process. Processes are therefore resampled first and repetitions within them
// (Kalibera and Jones 2013).
namespace cscd::bench {

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

}  // namespace cscd::bench
