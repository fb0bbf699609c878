#pragma once

#include "bench/inputs/input.h"
#include "bench/strategies/strategy_row.h"
#include "core/detect/radial_view.h"

namespace cscd::bench {

// Asks the observers of a strategy how they see the surface. The strategy is prepared once more for that,
// because an Answerer may have another strategy answer.
class StrategyObservers {
 public:
  // `input` must outlive it.
  StrategyObservers(const Input& input, const Strategy& strategy, const ElementaryTest& elementary)
      : input_(input),
        prepared_(strategy.make(setup_for(strategy, input.setup(elementary), input.clip->interval_count()))) {
  }

  const Preparation& preparation() const { return prepared_.preparation; }
  // Shows them an interval. Clusters of a strategy that follows the surface are as preparation cut them, the
  // same in every interval.
  Report look(const scenes::ClipInterval& interval) {
    ContactSet ignored;
    prepared_.detector->forget();
    return prepared_.detector->detect(input_.step(interval), ignored);
  }
  // How they saw that interval.
  RadialView view() const { return prepared_.detector->radial_view(); }

 private:
  const Input& input_;
  Prepared prepared_;
};

}  // namespace cscd::bench
