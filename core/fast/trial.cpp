#include "core/fast/trial.h"

#include <algorithm>
#include <limits>

#include "core/fast/cut/surface_clusters.h"
#include "core/fast/trial_poses.h"
#include "core/radial/atomic_clusters.h"
#include "core/radial/bone_clusters.h"

namespace cscd::fast {
namespace {

bool has_bones(const Setup& setup) {
  return setup.rig != nullptr && !setup.rig->parent.empty();
}

class CountingSink : public TrianglePairSink {
  void take(const std::vector<TrianglePair>&) override {}
};

// Work is counted in overlap tests of bounding volumes. These constants say how many overlap tests cost about
// as much as one patch in an interval, one look, one observer that is placed, and one pair of triangles that
// is left for the elementary test.
constexpr std::uint64_t kTestsOfPatch = 9, kTestsOfLook = 3, kTestsOfObserver = 10, kTestsOfPair = 40;
constexpr std::size_t kTrials = 6;
constexpr std::size_t kLeastCoarseCell = 96;  // `least_cell` that cuts short limbs into fewer patches

// Returns the work of all trials. Stops early, and returns a sum above `most`, once the work is more than
// `most`.
std::uint64_t work(FastCuller& culler, std::span<const Trial> trials, std::uint64_t most) {
  std::uint64_t tests = 0;
  for (const Trial& trial : trials) {
    if (tests > most) break;
    CountingSink sink;
    const Motion motion(trial[0], trial[1]);
    culler.refit(motion);
    culler.classify(motion, nullptr);
    const CullCounts counts = culler.cull(sink);
    tests += kTestsOfPatch * culler.patch_count() + kTestsOfLook * culler.looks_per_interval() +
             kTestsOfObserver * counts.radial->clusters + *counts.bvot + kTestsOfPair * sink.count();
  }
  return tests;
}

Candidate made(const Setup& setup, std::vector<std::int32_t> cluster_of, const DrvbcFastOptions& options,
               std::size_t least_cell = kLeastCell) {
  auto culler = std::make_unique<FastCuller>(setup, cluster_of, least_cell, options);
  return {std::move(cluster_of), least_cell, std::move(culler)};
}

// Keeps the candidate that makes the least work.
class Choice {
 public:
  explicit Choice(std::vector<Trial> trials) : trials_(std::move(trials)) {}

  // Tries the candidate with three covers, two and one.
  void consider(Candidate candidate) {
    bool better = false;
    for (std::size_t count = kCovers; count > 0; --count) {
      candidate.culler->use_covers(count);
      const std::uint64_t needed = work(*candidate.culler, trials_, least_);
      if (needed >= least_) continue;
      better = true, covers_ = count, least_ = needed;
    }
    if (better) best_ = std::move(candidate);
  }
  Candidate& best() { return best_; }
  std::size_t covers() const { return covers_; }

 private:
  std::vector<Trial> trials_;
  Candidate best_;
  std::size_t covers_ = 0;
  std::uint64_t least_ = std::numeric_limits<std::uint64_t>::max();
};

}  // namespace

Candidate best_candidate(const Setup& setup, const DrvbcFastOptions& options, StageClock& clock) {
  using Clusters = DrvbcFastOptions::Clusters;
  if (!has_bones(setup) || options.clusters == Clusters::of_surface || !setup.mesh.closed_and_oriented())
    return made(setup, surface_clusters(setup.mesh, setup.reference), options);
  const std::vector<BoneId> bone_of = radial::bones_of_triangles(setup, {}, clock);
  std::vector<std::int32_t> of_bones = radial::make_atomic_clusters(setup.mesh, bone_of).of_triangle;
  if (options.clusters == Clusters::of_bones) return made(setup, std::move(of_bones), options);

  // A row of the ablation takes the candidate that `drvbc_fast` with all its ideas would take, so that the
  // rows differ in nothing but the idea that is left out.
  const DrvbcFastOptions whole{.name = options.name, .complete = options.complete};
  Choice choice(trial_poses(setup.mesh, setup.reference, *setup.rig, bone_of, kTrials));
  choice.consider(made(setup, std::move(of_bones), whole));
  choice.consider(made(setup, surface_clusters(setup.mesh, setup.reference), whole));
  choice.consider(made(setup, choice.best().cluster_of, whole, kLeastCoarseCell));
  Candidate best = std::move(choice.best());
  if (options != whole) best = made(setup, std::move(best.cluster_of), options, best.least_cell);
  best.culler->use_covers(std::min(choice.covers(), options.covers));
  return best;
}

}  // namespace cscd::fast
