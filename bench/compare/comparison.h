#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bench/compare/side.h"
#include "bench/compare/times.h"
#include "bench/compare/truth.h"
#include "bench/compare/work.h"
#include "bench/output/exit_status.h"

namespace cscd::bench {

inline constexpr std::string_view kComparisonSchema = "cscd.compare/1";

enum class Lane {
  all,
  counters  // times are left out, as they say nothing on a machine that is not quiet
};

enum class ComparisonVerdict {
  nothing_worse,
  worse,          // more of a cost, more memory or more time
  less_true,      // whatever the times say
  not_comparable  // something that was asked for could not be compared, and what could is not worse
};

// What could not be compared, and why.
struct Refusal {
  std::string scene, what, reason;
};

// Everything that distinguishes a new program from an old one, the gravest first.
struct Comparison {
  Lane lane = Lane::all;
  std::string old_commit, new_commit;
  bool old_dirty = false, new_dirty = false;
  std::vector<std::string> scenes;       // compared
  std::vector<std::string> only_in_one;  // scenes and rows that one side does not have
  std::vector<TruthFinding> truth;
  std::size_t compared_answers = 0, compared_counts = 0;
  std::vector<CounterFinding> counters;
  std::vector<FootprintFinding> footprint;
  std::vector<TimeFinding> times;
  std::vector<UnjudgedTime> unjudged_times;  // of the scenes without a verdict about times
  std::vector<MeanFinding> means;
  std::vector<Refusal> refusals;

  ComparisonVerdict verdict() const;
};

Comparison compare(const Side& before, Side after, Lane lane);

// 0 nothing worse, 1 worse or less true, 2 not comparable.
ExitStatus exit_status(ComparisonVerdict verdict);
std::string_view to_string(ComparisonVerdict verdict);

nlohmann::ordered_json comparison_json(const Comparison& comparison);
// For a terminal: the verdict and its reason first, then what differs most. `all` leaves nothing out.
std::string comparison_text(const Comparison& comparison, bool all = false);
// For a pull request: the verdict, what changed, and all times folded away.
std::string comparison_markdown(const Comparison& comparison);

}  // namespace cscd::bench
