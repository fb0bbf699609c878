#pragma once

#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "bench/harness/contestant.h"
#include "bench/harness/measurement.h"
#include "scenes/random/random_interval.h"

namespace cscd::bench {

// A random interval as the input of a run.
inline Input random_input(std::uint64_t seed) {
  auto clip = std::make_unique<scenes::Clip>(scenes::make_random_interval(seed).clip);
  TriangleMesh mesh(clip->header().triangles, clip->header().vertex_count, "random interval");
  const std::span<const Vec3> first = clip->frame(0).positions;
  std::vector<Vec3> reference(first.begin(), first.end());
  std::optional<Rig> rig = scenes::rig_of(*clip);
  return {"random", std::move(clip), std::move(mesh), std::move(reference), std::move(rig)};
}

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
