#include "bench/tables/run_times.h"

#include <algorithm>
#include <cstdio>

#include "bench/tables/quantity.h"
#include "core/base/number_text.h"

namespace cscd::bench {
namespace {

constexpr char kReference[] = "base";

std::string beside_reference(const std::string& strategy, const Record& record) {
  if (strategy == kReference || record.strategy(kReference) == nullptr) return "";
  const Measured faster = median_query(kReference, record, strategy);
  if (!faster.value || *faster.value <= 0) return "";
  const bool slower = *faster.value < 1;
  return "  " + figure_text(slower ? 1 / *faster.value : *faster.value) + " times " +
         (slower ? "slower" : "faster") + (faster.marked ? std::string(kShortfallMark) : "") + " than " +
         kReference;
}

}  // namespace

std::string too_few_text(const Record& record) {
  constexpr std::size_t kLeastRepetitions = 5;  // bench/METHODOLOGY.md
  for (const StrategyRecord& strategy : record.strategies) {
    if (strategy.ms.empty()) continue;
    const std::size_t repetitions = strategy.ms.begin()->second.size();
    if (repetitions < kLeastRepetitions)
      return "times are of " + std::to_string(repetitions) + " repetitions of " +
             std::to_string(record.timed_intervals.size()) + " intervals, too few to conclude anything from";
  }
  return "";
}

std::string no_claims_text(const Record& record) {
  const std::size_t whole = record.scene.frames > 0 ? record.scene.frames - 1 : record.intervals;
  const std::string few = too_few_text(record);
  if (record.intervals >= whole) return few;
  return "the record of " + record.scene.name + " spans " + std::to_string(record.intervals) + " of " +
         std::to_string(whole) + " intervals" + (few.empty() ? "" : ", and its " + few);
}

std::string run_times_text(const Record& record) {
  const std::string few = too_few_text(record);  // then no row is called faster than another
  std::size_t width = 0;
  std::string rows;
  for (const StrategyRecord& strategy : record.strategies) width = std::max(width, strategy.name.size());
  for (const StrategyRecord& strategy : record.strategies) {
    const Measured total = median_query(strategy.name, record);
    if (!total.value) continue;
    char text[128];
    std::snprintf(text, sizeof text, "  %-*s %10s ms%s", static_cast<int>(width), strategy.name.c_str(),
                  figure_text(*total.value).c_str(), total.marked ? "*" : "");
    rows += text + (few.empty() ? beside_reference(strategy.name, record) : "") + "\n";
  }
  if (rows.empty()) return "";
  return few + (few.empty() ? "" : "\n") + "median total of an interval, with refit:\n" + rows +
         shortfall_note({&record, 1});
}

}  // namespace cscd::bench
