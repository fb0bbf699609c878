#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bench/compare/work.h"
#include "bench/records/record.h"
#include "bench/statistics/statistics.h"

namespace cscd::bench {

// The stage that stands for a whole query: all stages that a query consists of.
inline constexpr std::string_view kTotal = "total";

// The stages of a row that can be compared: those of a query, `total`, `embedding` (the test of the start),
// and `preparation`, making the strategy. A row without times has none.
std::vector<std::string> stages_of(const StrategyRecord& row);

// Milliseconds of a stage, [repetition][interval], of those `intervals` that the record has timed. What one
// preparation took counts as one interval. Empty where the row does not have that stage.
ProcessTimes stage_times(const Record& record, const StrategyRecord& row, const std::string& stage,
                         std::span<const std::size_t> intervals);

// The means of these over the timed intervals, one a repetition.
std::vector<double> stage_samples(const Record& record, const StrategyRecord& row, const std::string& stage);

// What one stage of one row takes in the new program, compared with the old. Shares are of 1: 0.03 is three
// per cent.
struct TimeFinding {
  std::string scene, row, stage;
  std::size_t pairs = 0;               // of processes
  double before_ms = 0, after_ms = 0;  // an interval, medians over the processes
  ProcessRatio resampled = {};
  Estimate ratio = {};             // after over before, with its interval
  double floor = 0;                // the least change that would be reported however small the noise
  double noise_floor = 0;          // what two sets of as many old processes differ by (95 of 100)
  double smallest_detectable = 0;  // the change that these samples would show in 4 of 5 such comparisons
  std::size_t pairings = 0, agreeing = 0;
  Change change = Change::same;
  // Why a change that the interval shows is not reported; empty where it is, or where there is none.
  std::string withheld = {};
  bool of_shortfall = false;  // the row answers less than a complete one (bench/records/shortfall.h)
};

// The whole query of a row where no verdict about its times is possible. A side without such times has none.
struct UnjudgedTime {
  std::string scene, row;
  std::optional<double> before_ms, after_ms;  // an interval, medians over the processes
  bool of_shortfall = false;                  // as in TimeFinding
};

// The geometric mean over scenes of what the whole query of a row takes, after over before.
struct MeanFinding {
  std::string row;
  std::size_t scenes = 0;
  Estimate ratio;
};

// Returns every row and stage of a scene that both have times of. The k-th process of one side is paired with
// the k-th of the other. A change is reported where all of this holds:
// - the interval of the ratio excludes 1. Intervals are simultaneous: they are so wide that all of one
//   comparison hold together but for the share of `false_reports` (comparison.json; Bonferroni);
// - the change exceeds the relative and the absolute floor (comparison.json);
// - all pairings agree in its sign. A pairing is a layout of the old program with one of the new; where each
//   has one layout, it is a third of the pairs, in order of time.
// `comparisons` is how many rows, stages and scenes the whole answer compares.
std::vector<TimeFinding> compare_times(std::span<const Record> before, std::span<const Record> after,
                                       std::size_t comparisons);

// How many rows and stages of a scene can be compared.
std::size_t count_times(std::span<const Record> before, std::span<const Record> after);

// Why times of two sides cannot be compared: no times, other machines, other settings, too few processes,
// not measured in turns. Empty where they can.
std::string times_refused(std::span<const Record> before, std::span<const Record> after);

// Returns what the whole queries of each row took on the intervals that each side timed; on those that both
// timed, where there are any. Either side may be empty.
std::vector<UnjudgedTime> unjudged_times(const std::string& scene, std::span<const Record> before,
                                         std::span<const Record> after);

std::vector<MeanFinding> mean_over_scenes(std::span<const TimeFinding> times, std::size_t comparisons);

}  // namespace cscd::bench
