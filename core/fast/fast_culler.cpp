#include "core/fast/fast_culler.h"

#include <algorithm>

namespace cscd::fast {
namespace {

constexpr std::size_t kRange = 32;  // the number of patches that is worth another thread
constexpr std::size_t kAhead = 2;   // positions are fetched so many patches before the look

std::vector<CappedClusters> capped(const Setup& setup, const Covers& covers,
                                   const DrvbcFastOptions& options) {
  std::vector<CappedClusters> capped;
  if (options.complete)
    for (std::size_t c = 0; c < covers.size(); ++c)
      capped.emplace_back(setup.mesh, setup.reference, covers[c], c);
  return capped;
}

}  // namespace

FastCuller::FastCuller(const Setup& setup, std::span<const std::int32_t> cluster_of,
                       const DrvbcFastOptions& options)
    : mesh_(setup.mesh),
      reference_(setup.reference),
      cut_(cut_surface(setup.mesh, setup.reference, cluster_of)),
      options_(options),
      positions_(setup.reference),
      certificates_(cut_.tree, cut_.covers, capped(setup, cut_.covers, options)),
      stars_(setup.mesh),
      team_(setup.threads),
      descent_({cut_.tree, positions_, certificates_, options.stars ? &stars_ : nullptr, options.time_linear,
                options.planes},
               team_),
      bounds_(cut_.tree.nodes.size()) {
  use_covers(options.covers);
}

void FastCuller::refit(const Motion& motion) {
  positions_.update(motion, team_);
  grid_ = Grid(positions_.error());
}

bool FastCuller::classify(const Motion& motion, const Rig::Interval*) {
  if (following_ && tests_ && positions_.known()) following_->follow(motion.start(), *tests_, certificates_);
  certificates_.start(positions_);
  team_.ranges(patch_count(), kRange, [&](std::size_t first, std::size_t last, std::size_t) {
    for (std::size_t p = first; p < last; ++p) look(p);
  });
  cut_.tree.for_each_inner_upwards([&](std::size_t n, const PatchTree::Node& node) {
    bounds_[n] = united(bounds_[node.left()], bounds_[node.right()]);
  });
  certificates_.finish();
  if (!positions_.known()) std::fill(bounds_.begin(), bounds_.end(), unbounded());
  return true;
}

CullCounts FastCuller::cull(TrianglePairSink& sink) {
  CullCounts counts;
  tests_ = descent_.run(bounds_, grid_, sink);
  counts.bvot = *tests_;
  counts.radial = certificates_.counts();
  return counts;
}

void FastCuller::forget() {
  if (following_) following_->forget(certificates_);
  tests_.reset();
}

void FastCuller::look(std::size_t patch) {
  fetch(patch + kAhead);
  const PatchLanes lanes = load(positions_.records(), cut_.tree.patches[patch].vertex);
  NodeBounds& bounds = bounds_[static_cast<std::size_t>(cut_.tree.leaf[patch])];
  bounds = grid_.bounds_of(lanes);
  if (!options_.time_linear) bounds = swept(bounds);
  certificates_.look(patch, lanes);
}

void FastCuller::fetch(std::size_t patch) const {
  if (patch >= patch_count()) return;
  __builtin_prefetch(&bounds_[static_cast<std::size_t>(cut_.tree.leaf[patch])], 1);
  for (const std::int32_t v : cut_.tree.patches[patch].vertex)
    __builtin_prefetch(&positions_.records()[static_cast<std::size_t>(v)]);
}

}  // namespace cscd::fast
