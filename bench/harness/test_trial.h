#pragma once

#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "bench/harness/contestant.h"
#include "bench/harness/measurement.h"
#include "bench/inputs/test_inputs.h"

namespace cscd::bench {

// A run of some rows on the one interval of an input, step by step.
struct Trial {
  Input input;
  std::vector<Contestant> contestants;
  Measurement measurement;
  std::vector<std::size_t> all = {0};  // its intervals

  Trial(Input input_in, std::span<const StrategyRow> rows, const ElementaryTest& exact,
        const ElementaryTest& timed)
      : input(std::move(input_in)),
        contestants(make_contestants(input, rows, exact, timed)),
        measurement({input, contestants, exact, timed}) {}

  SectionResult& verify() { return measurement.count({all, all, all}); }
  // Judges only where rows disagree.
  SectionResult& count() { return measurement.count({all, {}, all}); }
  void time(std::size_t repetitions) {
    std::mt19937_64 random(1);
    measurement.time({repetitions, random, true});
  }
};

}  // namespace cscd::bench
