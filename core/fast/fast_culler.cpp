#include "core/fast/fast_culler.h"

#include <algorithm>
#include <utility>

namespace cscd::fast {
namespace {

constexpr std::size_t kRange = 512;        // patches that are looked at together, 20 microseconds of work
constexpr std::size_t kCappedRange = 128;  // patches where caps are looked at too
constexpr std::size_t kAhead = 2;          // positions are fetched so many patches before the look
constexpr std::size_t kSampled = 256;      // about so many patches are asked how far they move
constexpr std::size_t kMostCollected = std::size_t{1} << 22;  // pairs, before parts are given up

std::vector<CappedClusters> capped(const StrategyInput& setup, const Covers& covers,
                                   const DrvbcFastOptions& options) {
  std::vector<CappedClusters> capped;
  if (options.complete)
    for (std::size_t c = 0; c < covers.size(); ++c)
      capped.emplace_back(setup.mesh, setup.reference, covers[c], c);
  return capped;
}

}  // namespace

FastCuller::FastCuller(const StrategyInput& setup, CutSurface cut, const DrvbcFastOptions& options)
    : mesh_(setup.mesh),
      reference_(setup.reference),
      cut_(std::move(cut)),
      options_(options),
      signs_suffice_(options.complete && setup.mesh.closed_and_oriented()),
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
  motion_ = motion;
  positions_.update(motion, team_);
  grid_ = Grid(positions_.error());
}

bool FastCuller::classify(const Step& step) {
  by_signs_ = step.starts_embedded && signs_suffice_;
  look_at(step.motion);
  return true;
}

void FastCuller::look_at(const Motion& motion) {
  if (following_) following_->mend(certificates_);
  if (following_ && tests_ && positions_.known()) following_->follow(motion.start(), *tests_, certificates_);
  const bool by_caps = options_.complete && !by_signs_;
  certificates_.use_contour_test(by_caps);
  certificates_.start(positions_, team_);
  team_.ranges(patch_count(), by_caps ? kCappedRange : kRange,
               [&](std::size_t first, std::size_t last, std::size_t) {
                 for (std::size_t p = first; p < last; ++p) look(p);
               });
  cut_.tree.for_each_inner_upwards(team_, [&](std::size_t n, const PatchTree::Node& node) {
    bounds_[n] = united(bounds_[node.left()], bounds_[node.right()]);
  });
  certificates_.finish(team_);
  if (!positions_.known()) std::fill(bounds_.begin(), bounds_.end(), unbounded());
}

CullCounts FastCuller::cull(TrianglePairSink& sink) {
  CullCounts counts;
  counts.radial = certificates_.counts();
  counts.bvot = descend(sink);
  return counts;
}

std::optional<std::uint64_t> FastCuller::cull_rest(TrianglePairSink& sink) {
  if (!by_signs_) return std::nullopt;
  by_signs_ = false;
  tests_.reset();  // the cover stays as it is within an interval
  refit(*motion_);
  look_at(*motion_);
  return descend(sink);
}

// Passes on the pairs of the interval that has been looked at, and returns the number of overlap tests.
std::uint64_t FastCuller::descend(TrianglePairSink& sink) {
  if (options_.long_descent != DrvbcFastOptions::kNever && positions_.known()) {
    const Moved moved = move_apart();
    // A position in between, start + t (end - start), rounds three times. Far from the origin it may be off
    // by so much that the grid's steps are wider than patches, and then nothing is proven apart.
    rounding_ = 0x1p-50 * positions_.largest_in_scene();
    const bool can_tell = Grid(positions_.error_beside(rounding_)).steps() * moved.width >= 1;
    if (moved.far() && can_tell) return cull_parts(sink);
  }
  return *(tests_ = descent_.run(bounds_, grid_, sink));
}

// How far places of the surface move apart, on the average.
FastCuller::Moved FastCuller::move_apart() const {
  const auto at = [&](std::int32_t vertex, std::size_t end) {
    const float* const p = &positions_.records()[static_cast<std::size_t>(vertex)].at[4 * end];
    return Eigen::Vector3f(p[0], p[1], p[2]);
  };
  const auto moved = [&](std::size_t p) {
    const std::int32_t v = cut_.tree.patches[p].vertex[0];
    return Eigen::Vector3f(at(v, 1) - at(v, 0));
  };
  const std::size_t stride = patch_count() / kSampled + 1;
  Eigen::Vector3f mean = Eigen::Vector3f::Zero();
  float samples = 0, way = 0, width = 0;
  for (std::size_t p = 0; p < patch_count(); p += stride) mean += moved(p), ++samples;
  mean /= samples;
  for (std::size_t p = 0; p < patch_count(); p += stride) {
    const auto& vertex = cut_.tree.patches[p].vertex;
    way += (moved(p) - mean).norm();
    width += (at(vertex.back(), 0) - at(vertex.front(), 0)).norm();
  }
  return {way / samples, width / samples};
}

// The parts pass on a pair of triangles again and again, so pairs are collected first.
std::uint64_t FastCuller::cull_parts(TrianglePairSink& sink) {
  found_.pairs.clear();
  use_whole_step_ = false;
  std::uint64_t tests = cull_part({0, kFinest});
  if (use_whole_step_) {
    rounding_ = 0;  // both ends of the interval are given
    begin({0, kFinest});
    found_.pairs.clear();
    return tests + *(tests_ = descent_.run(bounds_, grid_, sink));
  }
  for (TrianglePair& pair : found_.pairs)
    if (pair.b < pair.a) std::swap(pair.a, pair.b);
  const auto ends = [](const TrianglePair& pair) { return std::pair(pair.a, pair.b); };
  std::ranges::sort(found_.pairs, {}, ends);
  const auto same = [&](const TrianglePair& a, const TrianglePair& b) { return ends(a) == ends(b); };
  found_.pairs.erase(std::unique(found_.pairs.begin(), found_.pairs.end(), same), found_.pairs.end());
  for (const TrianglePair& pair : found_.pairs) sink.add(pair.a, pair.b);
  return tests;
}

// Collects the pairs of a part that has been looked at, and returns the number of overlap tests. A part in
// which the surface moves far is halved if its descent and its pairs cost too much.
std::uint64_t FastCuller::cull_part(const Part& part) {
  if (use_whole_step_) return 0;
  const bool can_split = part.last - part.first > 1 && move_apart().far();
  const std::uint64_t most = can_split ? options_.long_descent * patch_count() : SharedDescent::kAnyNumber;
  const std::size_t before = found_.pairs.size();
  found_.restart();
  tests_ = descent_.run(bounds_, grid_, found_, most);
  found_.flush();
  if (!can_split || *tests_ + kTestsOfPair * found_.count() <= most) {
    use_whole_step_ = found_.pairs.size() > kMostCollected;
    return *tests_;
  }
  found_.pairs.resize(before);
  std::uint64_t tests = std::min(*tests_, most);  // how many more were made depends on the number of threads
  tests_.reset();
  const unsigned middle = (part.first + part.last) / 2;
  for (const Part& half : {Part{part.first, middle}, Part{middle, part.last}}) {
    begin(half);
    use_whole_step_ |= !positions_.known();  // every pair of triangles would be collected
    tests += cull_part(half);
  }
  return tests;
}

// Looks at a part of the interval.
void FastCuller::begin(const Part& part) {
  const std::span<const Vec3> start = motion_->start(), end = motion_->end();
  const auto at = [&](unsigned time, std::vector<Vec3>& positions) {
    if (time == 0) return start;
    if (time == kFinest) return end;
    positions.resize(start.size());
    const double t = static_cast<double>(time) / kFinest;
    for (std::size_t v = 0; v < start.size(); ++v) positions[v] = start[v] + t * (end[v] - start[v]);
    return std::span<const Vec3>(positions);
  };
  const Motion motion(at(part.first, part_start_), at(part.last, part_end_));
  positions_.update(motion, team_, rounding_);
  grid_ = Grid(positions_.error());
  look_at(motion);
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
