#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "bench/input/input.h"
#include "bench/record/record.h"
#include "core/detect/strategy.h"

namespace cscd::bench {

// A strategy made twice for one input: to be judged, with the exact elementary test, and to be timed.
struct Contestant {
  const Strategy* strategy;
  Pipeline pipeline = Pipeline::today;
  std::unique_ptr<Detector> judged, timed;
  PreparationRecord preparation;
  int threads = 1;  // on which it answers
};

// Throws InputError when the input lacks what a strategy needs. The input must outlive the detectors.
std::vector<Contestant> make_contestants(const Input& input, std::span<const Strategy* const> strategies,
                                         const ElementaryTest& exact, const ElementaryTest& timed,
                                         Pipeline pipeline = Pipeline::today);

// Strategies by name, or all of a group that the input allows; without names, those without a group that it
// allows. Rows that the pipeline does not have are left out of groups. Throws InputError for a name that is
// not known, and for a row that is named and that the pipeline does not have.
std::vector<const Strategy*> chosen_strategies(const Input& input, std::span<const std::string> names,
                                               Pipeline pipeline = Pipeline::today);

}  // namespace cscd::bench
