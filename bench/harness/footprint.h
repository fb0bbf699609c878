#pragma once

#include <span>

#include "bench/inputs/input.h"
#include "bench/records/record.h"
#include "bench/strategies/strategy_row.h"
#include "core/detect/strategy.h"

namespace cscd::bench {

// A strategy made and measured while it was made and answered one interval twice.
struct Made {
  Prepared prepared;
  Footprint footprint;  // without instructions
  double make_ms = 0;   // before it answered
};
Made make_measured(Input& input, const StrategyRow& row, const ElementaryTest& elementary,
                   std::size_t interval);

// Makes the strategy anew and runs it on the intervals, of which there is at least one.
Footprint measure_footprint(Input& input, const StrategyRow& row, const ElementaryTest& elementary,
                            std::span<const std::size_t> intervals);

}  // namespace cscd::bench
