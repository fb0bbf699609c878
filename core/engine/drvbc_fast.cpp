#include "core/engine/drvbc_fast.h"

#include <algorithm>
#include <limits>

#include "core/base/error.h"
#include "core/base/stage_clock.h"
#include "core/base/team.h"
#include "core/detect/compose.h"
#include "core/engine/certificates.h"
#include "core/engine/shared_descent.h"
#include "core/engine/surface_clusters.h"
#include "core/engine/trial_poses.h"
#include "core/radial/atomic_clusters.h"
#include "core/radial/bone_clusters.h"

// Radial view based culling after the paper (drvbc.cpp), taken further: one tree over patches of sixteen
// triangles; covers whose seams lie inside one another's clusters instead of mega clusters (certificates.h);
// bounds of both ends of the interval instead of whole paths (grid_bounds.h); stars of vertices for the
// neighbours that are left (stars.h), planes of triangles for the pairs (parting.h); and, where all contacts
// are promised, a contour test (capped_clusters.h). What a "no" proves stands there.
//
// A pass over all vertices, one over all patches, and a descent that meets what no cover certifies
// (patch_descent.h), all three on as many threads as there are to be.
namespace cscd {
namespace fast {
namespace {

constexpr std::size_t kRange = 32;  // patches worth another thread
constexpr std::size_t kAhead = 2;   // patches by which positions are fetched before they are looked at

std::vector<CappedClusters> capped(const Setup& setup, const Covers& covers,
                                   const DrvbcFastOptions& options) {
  std::vector<CappedClusters> capped;
  if (options.complete)
    for (std::size_t c = 0; c < covers.size(); ++c)
      capped.emplace_back(setup.mesh, setup.reference, covers[c], c);
  return capped;
}

class FastCuller : public Culler {
 public:
  FastCuller(const Setup& setup, Covers covers, std::size_t least_cell, const DrvbcFastOptions& options)
      : covers_(std::move(covers)),
        options_(options),
        positions_(setup.reference),
        tree_(make_patches(setup.mesh, setup.reference, covers_, least_cell)),
        certificates_(tree_, covers_, capped(setup, covers_, options)),
        stars_(setup.mesh),
        team_(setup.threads),
        descent_({tree_, positions_, certificates_, options.stars ? &stars_ : nullptr, options.time_linear,
                  options.planes},
                 team_),
        bounds_(tree_.nodes.size()) {
    use_covers(options.covers);
  }

  void use_covers(std::size_t count) { certificates_.use_covers(count); }

  void refit(const Motion& motion) override {
    positions_.update(motion, team_);
    grid_ = Grid(positions_.error());
  }

  // Bounds too, as a patch is loaded once for both.
  bool classify(const Motion&, const Rig::Interval*) override {
    certificates_.start(positions_);
    team_.ranges(tree_.patches.size(), kRange, [&](std::size_t first, std::size_t last, std::size_t) {
      for (std::size_t p = first; p < last; ++p) look(p);
    });
    tree_.for_each_inner_upwards([&](std::size_t n, const PatchTree::Node& node) {
      bounds_[n] = united(bounds_[node.left()], bounds_[node.right()]);
    });
    certificates_.finish();
    if (!positions_.known()) std::fill(bounds_.begin(), bounds_.end(), unbounded());
    return true;
  }

  CullCounts cull(TrianglePairSink& sink) override {
    CullCounts counts;
    counts.bvot = descent_.run(bounds_, grid_, sink);
    counts.radial = certificates_.counts();
    return counts;
  }

  RadialView radial_view() const override { return certificates_.view(); }
  std::size_t patch_count() const { return tree_.patches.size(); }
  std::size_t looks() const { return certificates_.looks(); }

 private:
  void look(std::size_t patch) {
    fetch(patch + kAhead);
    const PatchLanes lanes = load(positions_.records(), tree_.patches[patch].vertex);
    NodeBounds& bounds = bounds_[static_cast<std::size_t>(tree_.leaf[patch])];
    bounds = grid_.bounds_of(lanes);
    if (!options_.time_linear) bounds = swept(bounds);
    certificates_.look(patch, lanes);
  }

  void fetch(std::size_t patch) const {
    if (patch >= tree_.patches.size()) return;
    __builtin_prefetch(&bounds_[static_cast<std::size_t>(tree_.leaf[patch])], 1);
    for (const std::int32_t v : tree_.patches[patch].vertex)
      __builtin_prefetch(&positions_.records()[static_cast<std::size_t>(v)]);
  }

  Covers covers_;
  DrvbcFastOptions options_;
  LocalPositions positions_;
  PatchTree tree_;
  Certificates certificates_;
  Stars stars_;
  Team team_;
  SharedDescent descent_;
  Grid grid_{1};
  std::vector<NodeBounds> bounds_;  // of each node
};

bool has_bones(const Setup& setup) {
  return setup.rig != nullptr && !setup.rig->parent.empty();
}

class CountingSink : public TrianglePairSink {
  void take(const std::vector<TrianglePair>&) override {}
};

// Work in overlap tests. About so many cost as much as a patch in an interval, a look at it from one cover,
// an observer that is placed, or a pair that is left.
constexpr std::uint64_t kTestsOfPatch = 9, kTestsOfLook = 3, kTestsOfObserver = 10, kTestsOfPair = 40;
constexpr std::size_t kTrials = 6;
constexpr std::size_t kLeastCoarseCell = 96;  // leaves short limbs in fewer patches

// Gives up where it is more than `most`.
std::uint64_t work(FastCuller& culler, std::span<const Trial> trials, std::uint64_t most) {
  std::uint64_t tests = 0;
  for (const Trial& trial : trials) {
    if (tests > most) break;
    CountingSink sink;
    const Motion motion(trial[0], trial[1]);
    culler.refit(motion);
    culler.classify(motion, nullptr);
    const CullCounts counts = culler.cull(sink);
    tests += kTestsOfPatch * culler.patch_count() + kTestsOfLook * culler.looks() +
             kTestsOfObserver * counts.radial->clusters + *counts.bvot + kTestsOfPair * sink.count();
  }
  return tests;
}

// How a surface is cut.
struct Cut {
  std::vector<std::int32_t> cluster_of;  // of the first cover
  std::size_t least_cell = kLeastCell;
};
struct Candidate {
  Cut cut;
  std::unique_ptr<FastCuller> culler;
};

Candidate made(const Setup& setup, Cut cut, const DrvbcFastOptions& options) {
  auto culler = std::make_unique<FastCuller>(setup, make_covers(setup.mesh, setup.reference, cut.cluster_of),
                                             cut.least_cell, options);
  return {std::move(cut), std::move(culler)};
}

// Keeps the candidate that makes the least work in a few poses.
class Choice {
 public:
  explicit Choice(std::vector<Trial> trials) : trials_(std::move(trials)) {}

  // With as many covers as are worth while.
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

// Of clusters of bones or of the surface, cut into more or fewer cells, and with as many covers, as make the
// least work where bones turn.
Candidate chosen(const Setup& setup, const DrvbcFastOptions& options, StageClock& clock) {
  using Clusters = DrvbcFastOptions::Clusters;
  if (!has_bones(setup) || options.clusters == Clusters::of_surface || !setup.mesh.closed_and_oriented())
    return made(setup, {surface_clusters(setup.mesh, setup.reference)}, options);
  const std::vector<BoneId> bone_of = radial::bones_of_triangles(setup, {}, clock);
  std::vector<std::int32_t> of_bones = radial::make_atomic_clusters(setup.mesh, bone_of).of_triangle;
  if (options.clusters == Clusters::of_bones) return made(setup, {std::move(of_bones)}, options);

  // Rows that leave something out take what the whole would, so that nothing else differs.
  const DrvbcFastOptions whole{.name = options.name, .complete = options.complete};
  Choice choice(trial_poses(setup.mesh, setup.reference, *setup.rig, bone_of, kTrials));
  choice.consider(made(setup, {std::move(of_bones)}, whole));
  choice.consider(made(setup, {surface_clusters(setup.mesh, setup.reference)}, whole));
  choice.consider(made(setup, {choice.best().cut.cluster_of, kLeastCoarseCell}, whole));
  Candidate best = std::move(choice.best());
  if (options != whole) best = made(setup, std::move(best.cut), options);
  best.culler->use_covers(std::min(choice.covers(), options.covers));
  return best;
}

}  // namespace
}  // namespace fast

Prepared make_drvbc_fast(const Setup& setup, const DrvbcFastOptions& options) {
  if (!options.complete) require_closed_and_oriented(setup.mesh, "strategy " + std::string(options.name));
  if (setup.threads < 1)
    throw InputError("strategy " + std::string(options.name) + ": " + std::to_string(setup.threads) +
                     " threads; give at least one");
  StageClock clock;
  clock.enter(Stage::decomposition);
  auto [cut, culler] = fast::chosen(setup, options, clock);
  clock.stop();
  Preparation preparation;
  if (clock.milliseconds(Stage::distance_and_heat) > 0)
    preparation.distance_and_heat_ms = clock.milliseconds(Stage::distance_and_heat);
  preparation.decomposition_ms = clock.milliseconds(Stage::decomposition);
  preparation.atomic_clusters = 1 + *std::max_element(cut.cluster_of.begin(), cut.cluster_of.end());
  preparation.atomic_cluster = std::move(cut.cluster_of);
  preparation.threads = setup.threads;
  return {compose(std::move(culler), setup.mesh, setup.elementary), preparation};
}

}  // namespace cscd
