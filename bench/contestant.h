#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "bench/input.h"
#include "bench/record.h"
#include "core/detect/strategy.h"

namespace cscd::bench {

// A strategy made twice for one input: to be judged, with the exact elementary test, and to be timed.
struct Contestant {
  const Strategy* strategy;
  std::unique_ptr<Detector> judged, timed;
  PreparationRecord preparation;
};

// Throws InputError when the input lacks what a strategy needs. The input must outlive the detectors.
std::vector<Contestant> make_contestants(const Input& input, std::span<const Strategy* const> strategies,
                                         const ElementaryTest& exact, const ElementaryTest& timed);

// Those of the catalogue that the input allows, without those that bench/run.json leaves out.
std::vector<const Strategy*> default_strategies(const Input& input);

// "base: reason" lines of what bench/run.json leaves out.
std::string left_out_text();

}  // namespace cscd::bench
