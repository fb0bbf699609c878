#include "bench/contestant.h"

#include "bench/catalogue.h"
#include "bench/progress.h"

namespace cscd::bench {
namespace {

void add(const Preparation& sample, PreparationRecord& record) {
  if (sample.distance_and_heat_ms) record.distance_and_heat_ms.push_back(*sample.distance_and_heat_ms);
  if (sample.decomposition_ms) record.decomposition_ms.push_back(*sample.decomposition_ms);
  if (!sample.atomic_cluster.empty()) record.atomic_clusters = sample.atomic_clusters;
}

}  // namespace

std::vector<Contestant> make_contestants(const Input& input, std::span<const Strategy* const> strategies,
                                         const ElementaryTest& exact, const ElementaryTest& timed) {
  Progress progress("preparing " + input.name, 2 * strategies.size());
  std::vector<Contestant> contestants;
  for (const Strategy* strategy : strategies) {
    Contestant& contestant = contestants.emplace_back();
    contestant.strategy = strategy;
    const auto make = [&](const ElementaryTest& test) {
      Prepared prepared = strategy->make(input.setup(test));
      add(prepared.preparation, contestant.preparation);
      progress.advance();
      return std::move(prepared.detector);
    };
    contestant.judged = make(exact);
    contestant.timed = make(timed);
  }
  return contestants;
}

std::vector<const Strategy*> default_strategies(const Input& input) {
  std::vector<const Strategy*> chosen;
  for (const Strategy& strategy : strategies()) {
    const bool rigged = input.rig || !strategy.needs_rig;
    const bool allowed = input.mesh.closed_and_oriented() || strategy.guarantee == Guarantee::complete;
    if (&strategy != &all_pairs() && rigged && allowed) chosen.push_back(&strategy);
  }
  return chosen;
}

}  // namespace cscd::bench
