#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bench/inputs/input.h"
#include "bench/records/record.h"
#include "bench/strategies/strategy_row.h"
#include "core/detect/strategy.h"
#include "scenes/clip/clip.h"

namespace cscd::bench {

// A row made for one input: to be judged, with the exact elementary test, and to be timed. It is one detector
// where both tests are the same.
struct Contestant {
  StrategyRow row;
  std::shared_ptr<Detector> judged, timed;
  PreparationRecord preparation;
  int threads = 1;           // on which it answers
  Footprint footprint = {};  // of the timed detector, without instructions; empty where none was taken
  double make_ms = 0;        // that the timed detector took to make
};

// The set-up of a detector that leaves out what the input says is ignored, with the clip's bones if the
// strategy gets them.
StrategyInput measured_setup(const Input& input, const Strategy& strategy, const ElementaryTest& elementary,
                             bool first_only = false, Pipeline pipeline = Pipeline::vectorised);

// Throws InputError when the input lacks what a strategy needs. The input must outlive the detectors. The
// footprint is taken where `interval` names one, which the timed detector then answers twice.
Contestant make_contestant(Input& input, const StrategyRow& row, const ElementaryTest& exact,
                           const ElementaryTest& timed, std::optional<std::size_t> interval = std::nullopt);
std::vector<Contestant> make_contestants(Input& input, std::span<const StrategyRow> rows,
                                         const ElementaryTest& exact, const ElementaryTest& timed);

// Says why a strategy cannot leave out what an input ignores; nothing where it can, or where nothing is
// ignored.
std::optional<std::string> why_not_ignoring(const Input& input, const Strategy& strategy);

// Rows by the texts that rows_called() reads; of a group, those that the input allows; without texts, those
// without a group that it allows. Rows that the pipeline does not have, that cannot leave out what the
// input ignores, or that do not know its thickness, are left out of groups. Throws InputError for a name that
// is not known, and for a row that is named and would be left out of a group.
std::vector<StrategyRow> chosen_rows(const Input& input, std::span<const std::string> texts,
                                     Pipeline pipeline = Pipeline::vectorised);

// What a strategy that follows the surface counts depends on the intervals before. So that every measurement
// of an interval is one of the same thing, such a detector forgets everything and is then asked the kLead
// intervals before that one, or as many as lead up to it. This is its state in a simulation that goes on from
// step to step.
inline constexpr std::size_t kLead = 24;

// Warms up strategies that adapt to the surface (StrategyKind::adaptive) by these intervals, and does nothing
// for the others. Load the interval that follows afterwards, because the clip then holds another one.
void lead_up(const Strategy& strategy, Detector& detector, Input& input, const IntervalRange& lead);

// An answer, sorted, and cut down to the earliest contacts where the row is asked for those alone.
struct Answered {
  Report report;
  ContactSet found;

  std::optional<double> first_time() const {
    return found.contacts.empty() ? std::nullopt : std::optional(found.contacts.front().time);
  }
};
// Sorting happens outside the detector's clock. `out` keeps its memory.
void ask(Detector& detector, const StrategyRow& row, const Step& step, Answered& out);

}  // namespace cscd::bench
