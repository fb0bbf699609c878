#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bench/compare/statistics/process_ratio.h"
#include "bench/measure/record/record.h"

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

}  // namespace cscd::bench
