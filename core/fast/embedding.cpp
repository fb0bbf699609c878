#include "core/fast/embedding.h"

#include "core/base/stage_clock.h"
#include "core/fast/trial.h"

namespace cscd {

EmbeddingTest make_embedding_test(const Setup& setup) {
  StageClock clock;
  clock.enter(Stage::decomposition);
  fast::Candidate best = fast::best_candidate(setup, {.name = "embedding test", .complete = true}, clock);
  return {setup.mesh, std::move(best.culler)};
}

}  // namespace cscd
