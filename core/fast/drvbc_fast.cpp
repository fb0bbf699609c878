#include "core/fast/drvbc_fast.h"

#include <algorithm>
#include <string>

#include "core/base/error.h"
#include "core/base/stage_clock.h"
#include "core/detect/compose.h"
#include "core/fast/trial.h"

namespace cscd {

Prepared make_drvbc_fast(const StrategyInput& setup, const DrvbcFastOptions& options) {
  if (!options.complete || options.starts_embedded)
    require_closed_and_oriented(setup.mesh, "strategy " + std::string(options.name));
  if (setup.threads < 1)
    throw InputError("strategy " + std::string(options.name) + ": " + std::to_string(setup.threads) +
                     " threads; give at least one");
  StageClock clock;
  clock.enter(Stage::decomposition);
  fast::TrialCuller best = fast::best_trial_culler(setup, options, clock);
  if (options.follows) best.culler->follow();
  clock.stop();
  Preparation preparation;
  if (clock.milliseconds(Stage::distance_and_heat) > 0)
    preparation.distance_and_heat_ms = clock.milliseconds(Stage::distance_and_heat);
  preparation.decomposition_ms = clock.milliseconds(Stage::decomposition);
  preparation.atomic_clusters = 1 + *std::max_element(best.cluster_of.begin(), best.cluster_of.end());
  preparation.atomic_cluster = std::move(best.cluster_of);
  preparation.threads = setup.threads;
  preparation.new_triangles = best.new_triangles;
  return {compose(std::move(best.culler), setup,
                  {.threads = setup.threads,
                   .starts_embedded = options.starts_embedded,
                   .remembers = options.follows,
                   .owners = options.complete}),
          preparation};
}

EmbeddingTest make_embedding_test(const StrategyInput& setup) {
  StageClock clock;
  clock.enter(Stage::decomposition);
  fast::TrialCuller best =
      fast::best_trial_culler(setup, {.name = "embedding test", .complete = true}, clock);
  return {setup.mesh, std::move(best.culler)};
}

}  // namespace cscd
