#include "bench/measure/contestant.h"

#include <algorithm>

#include "bench/output/progress.h"
#include "bench/rows/catalogue.h"
#include "core/base/error.h"

namespace cscd::bench {
namespace {

void add(const Preparation& sample, PreparationRecord& record) {
  if (sample.distance_and_heat_ms) record.distance_and_heat_ms.push_back(*sample.distance_and_heat_ms);
  if (sample.decomposition_ms) record.decomposition_ms.push_back(*sample.decomposition_ms);
  if (!sample.atomic_cluster.empty()) record.atomic_clusters = sample.atomic_clusters;
}

}  // namespace

std::vector<Contestant> make_contestants(const Input& input, std::span<const Strategy* const> strategies,
                                         const ElementaryTest& exact, const ElementaryTest& timed,
                                         Pipeline pipeline) {
  Progress progress("preparing " + input.name, 2 * strategies.size());
  std::vector<Contestant> contestants;
  for (const Strategy* strategy : strategies) {
    Contestant& contestant = contestants.emplace_back();
    contestant.strategy = strategy;
    contestant.pipeline = pipeline;
    const auto make = [&](const ElementaryTest& test) {
      Prepared prepared = strategy->make(input.setup(test, false, pipeline));
      add(prepared.preparation, contestant.preparation);
      contestant.threads = prepared.preparation.threads;
      progress.advance();
      return std::move(prepared.detector);
    };
    contestant.judged = make(exact);
    contestant.timed = make(timed);
  }
  return contestants;
}

std::vector<const Strategy*> chosen_strategies(const Input& input, std::span<const std::string> names,
                                               Pipeline pipeline) {
  const auto has = [&](const Strategy& strategy) {
    return pipeline == Pipeline::today || strategy.published;
  };
  std::vector<const Strategy*> chosen;
  const auto add = [&](const Strategy* strategy) {
    if (std::find(chosen.begin(), chosen.end(), strategy) == chosen.end()) chosen.push_back(strategy);
  };
  const auto add_group = [&](std::string_view group) {
    for (const Strategy* strategy : strategies_in(group))
      if (has(*strategy) && allows(input, *strategy)) add(strategy);
  };
  if (names.empty()) add_group("");
  for (const std::string& name : names)
    if (strategies_in(name).empty()) {
      const Strategy& strategy = strategy_named(name);
      if (!has(strategy))
        throw InputError("strategy " + name +
                         " is not of the paper, so the pipeline published does not have it; leave it out, or "
                         "run it with --pipeline today");
      add(&strategy);
    } else {
      add_group(name);
    }
  return chosen;
}

}  // namespace cscd::bench
