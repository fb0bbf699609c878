#include "bench/measure/replay/contestant.h"

#include <algorithm>

#include "bench/cli/output/progress.h"
#include "bench/measure/strategies/applicable.h"
#include "bench/measure/strategies/catalogue.h"
#include "core/base/error.h"

namespace cscd::bench {
namespace {

void add(const Preparation& sample, PreparationRecord& record) {
  if (sample.distance_and_heat_ms) record.distance_and_heat_ms.push_back(*sample.distance_and_heat_ms);
  if (sample.decomposition_ms) record.decomposition_ms.push_back(*sample.decomposition_ms);
  if (!sample.atomic_cluster.empty()) record.atomic_clusters = sample.atomic_clusters;
}

}  // namespace

StrategyInput measured_setup(const Input& input, const Strategy& strategy, const ElementaryTest& elementary,
                             bool first_only, Pipeline pipeline) {
  StrategyInput setup =
      setup_for(strategy, input.setup(elementary, first_only, pipeline), input.clip->interval_count());
  if (input.ignored) setup.exclusions = &input.ignored->triangles;
  return setup;
}

// What is ignored is dropped before it is tested. That is right where a strategy passes on all contacts.
std::optional<std::string> why_not_ignoring(const Input& input, const Strategy& strategy) {
  if (!input.ignored) return std::nullopt;
  if (strategy.own_test) return "its elementary test is its own, and knows nothing of what is ignored";
  if (strategy.guarantee == Guarantee::first_contact)
    return "it promises the first contact alone, which may be an ignored one";
  if (strategy.guarantee == Guarantee::heuristic) return "it promises nothing of what is not ignored";
  return std::nullopt;
}

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
      Prepared prepared = strategy->make(measured_setup(input, *strategy, test, false, pipeline));
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
    return pipeline == Pipeline::vectorised || strategy.kind == StrategyKind::published;
  };
  std::vector<const Strategy*> chosen;
  const auto add = [&](const Strategy* strategy) {
    if (std::find(chosen.begin(), chosen.end(), strategy) == chosen.end()) chosen.push_back(strategy);
  };
  const auto add_group = [&](std::string_view group) {
    for (const Strategy* strategy : strategies_in(group))
      if (has(*strategy) && allows(input, *strategy) && !why_not_ignoring(input, *strategy)) add(strategy);
  };
  if (names.empty()) add_group("");
  for (const std::string& name : names)
    if (strategies_in(name).empty()) {
      const Strategy& strategy = strategy_named(name);
      if (!has(strategy))
        throw InputError("strategy " + name +
                         " is not of the paper, so the pipeline published does not have it; leave it out, or "
                         "run it with --pipeline today");
      if (const auto reason = why_not_ignoring(input, strategy))
        throw InputError("strategy " + name + " cannot leave out what is ignored: " + *reason +
                         "; leave the strategy out, or --ignore and --ignore-neighbours");
      add(&strategy);
    } else {
      add_group(name);
    }
  return chosen;
}

}  // namespace cscd::bench
