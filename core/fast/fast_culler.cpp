#include "core/fast/fast_culler.h"

#include <algorithm>
#include <utility>

namespace cscd::fast {
namespace {

constexpr std::size_t kRange = 512;           // patches that are looked at together, 20 microseconds of work
constexpr std::size_t kCappedRange = 128;     // patches where caps are looked at too
constexpr std::size_t kAhead = 2;             // positions are fetched so many patches before the pass
constexpr std::size_t kSampled = 256;         // about so many patches are asked how far they move
constexpr std::size_t kWorthStopping = 1024;  // patches; the descent of fewer is too short to be stopped
// A part of the interval is cut short where that spares at least so much of it.
constexpr double kWorthCutting = 1.0 / 2;
// Where the first contact alone is wanted, a part whose descent takes more than so many overlap tests for
// each patch is halved, which is about what a pass over a part costs.
constexpr std::uint64_t kMostBySigns = 32, kMostByCaps = 64;
// At a distance, a pass by signs that leaves more pairs near on the surface for each patch takes longer than
// one by caps, which leaves none of them.
constexpr std::size_t kMostNear = 8;
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
      certificates_(setup.mesh, cut_.tree, cut_.covers, capped(setup, cut_.covers, options)),
      one_rings_(setup.mesh),
      pool_(setup.threads),
      descent_({cut_.tree, positions_, certificates_, options.one_rings ? &one_rings_ : nullptr,
                options.time_linear, options.planes},
               pool_),
      bounds_(cut_.tree.nodes.size()) {
  use_covers(options.covers);
}

void FastCuller::refit(const Step& step) {
  motion_ = step.motion;
  if (step.thickness.largest() != thickness_.largest()) near_ = 0;
  thickness_ = step.thickness;
  move_to({0, 1});
}

void FastCuller::refit_beginning(const Step& step, double until) {
  refit(step);
  if (until < 1 && can_tell_in_between(move_apart())) move_to({0, until});
}

bool FastCuller::classify(const Step& step) {
  by_signs_ = step.starts_embedded && signs_suffice_ && thickness_.is_uniform() &&
              (local_thickness_ == 0 || near_ <= kMostNear * patch_count());
  classify_all();
  return true;
}

void FastCuller::classify_all() {
  if (following_) following_->mend(certificates_);
  if (following_ && tests_ && positions_.known())
    following_->follow(motion_->start(), *tests_, certificates_);
  const bool by_caps = uses_caps();
  certificates_.use_contour_test(by_caps);
  certificates_.start(positions_, pool_, local_thickness_);
  pool_.ranges(patch_count(), by_caps ? kCappedRange : kRange,
               [&](std::size_t first, std::size_t last, std::size_t) {
                 for (std::size_t p = first; p < last; ++p) classify(p);
               });
  unite_bounds();
  certificates_.finish(pool_);
}

void FastCuller::unite_bounds() {
  cut_.tree.for_each_inner_upwards(pool_, [&](std::size_t n, const PatchTree::Node& node) {
    bounds_[n] = united(bounds_[node.left()], bounds_[node.right()]);
  });
  if (!positions_.known()) std::fill(bounds_.begin(), bounds_.end(), unbounded());
}

CullCounts FastCuller::cull(TrianglePairSink& sink) {
  CullCounts counts;
  counts.radial = certificates_.counts();
  counts.bvot = descend(sink);
  // A pose at rest is asked about beside the motion, and says nothing of the next step.
  if (motion_->start().data() == motion_->end().data()) tests_.reset();
  return counts;
}

std::optional<std::uint64_t> FastCuller::cull_rest(TrianglePairSink& sink) {
  if (!by_signs_) return std::nullopt;
  by_signs_ = false;
  tests_.reset();  // the cover stays as it is within an interval
  refit({.motion = *motion_, .thickness = thickness_});
  classify_all();
  return descend(sink);
}

// Passes on the pairs of the interval that has been looked at, and returns the number of overlap tests.
std::uint64_t FastCuller::descend(TrianglePairSink& sink) {
  if (sink.first_only()) return descend_to_first(sink);
  if (moves_far()) return cull_parts(sink);
  return *(tests_ = run(sink));
}

std::uint64_t FastCuller::run(TrianglePairSink& sink, std::uint64_t most) {
  pass_on_near(sink);
  return descent_.run(bounds_, grid_, sink, most);
}

// Passes on the pairs near on the surface of which signs say nothing (certify/tall_rings.h).
void FastCuller::pass_on_near(TrianglePairSink& sink) {
  if (local_thickness_ == 0 || uses_caps()) return;
  near_ = 0;
  sink.test_owned(true);
  certificates_.for_each_unsettled_pair([&](TriangleId a, TriangleId b) {
    ++near_;
    sink.add(a, b);
  });
  sink.test_owned(false);
}

// Passes on pairs until the sink needs no others. A long interval is looked at in parts, in the order of
// time: a part is halved as long as the surface moves far in it and its descent is long, and what is left
// behind it is the next part.
std::uint64_t FastCuller::descend_to_first(TrianglePairSink& sink) {
  const double end = part_.last;
  std::uint64_t tests = 0;
  while (true) {
    const std::uint64_t most = patience();
    const auto cut = [&] { return cut_short(sink); };
    SharedDescent::Outcome done;
    pass_on_near(sink);
    if (most != SharedDescent::kAnyNumber || patch_count() >= kWorthStopping)
      done = descent_.run_in_ranges(bounds_, grid_, sink, cut, most);
    else
      done.tests = descent_.run(bounds_, grid_, sink);
    tests_ = done.tests;
    tests += done.tests;
    if (done.stopped) {
      if (part_.first == 0) sink.begin_again();
      const double share = std::clamp(1 / (done.growth - 1), 1.0 / 8, 1.0 / 2);
      classify_within({part_.first, part_.first + share * (part_.last - part_.first)});
      continue;
    }
    sink.flush();
    if (part_.last == end || sink.until() <= part_.last || sink.closed()) return tests;
    if (part_.first == 0) sink.leave_start();
    classify_within({part_.last, std::min({end, sink.until(), 3 * part_.last - 2 * part_.first})});
  }
}

// Cuts the part short that is looked at, where the sink needs pairs up to a time alone that lies well before
// its end. From here on bounds, planes and one-rings are about what is left of the part. Certificates stay as
// they are, because what they say of the whole part they say of its beginning too. Those by caps, which lose
// most where the surface moves far, are made anew there: they prove pairs apart one by one, so that some
// ranges of a descent may go by one of them and others by the other.
std::optional<std::uint64_t> FastCuller::cut_short(TrianglePairSink& sink) {
  const double until = sink.until();
  const double length = part_.last - part_.first;
  if (until <= part_.first || until - part_.first > kWorthCutting * length) return std::nullopt;
  const Moved moved = move_apart();
  if (!can_tell_in_between(moved)) return std::nullopt;
  const TimeRange beginning{part_.first, until};
  if (uses_caps() && moved.far()) {
    classify_within(beginning);
    pass_on_near(sink);
    return patience();
  }
  move_to(beginning);
  pool_.ranges(patch_count(), kRange, [&](std::size_t first, std::size_t last, std::size_t) {
    for (std::size_t p = first; p < last; ++p) {
      fetch(p + kAhead);
      bound(p, load(positions_.records(), cut_.tree.patches[p].vertex));
    }
  });
  unite_bounds();
  return patience();
}

// Returns how many overlap tests the descent of a part may take before the part is halved.
std::uint64_t FastCuller::patience() const {
  if (part_.last - part_.first <= 1.0 / kFinest || !moves_far()) return SharedDescent::kAnyNumber;
  return (uses_caps() ? kMostByCaps : kMostBySigns) * patch_count();
}

bool FastCuller::moves_far() const {
  if (options_.long_descent == DrvbcFastOptions::kNever || !positions_.known()) return false;
  const Moved moved = move_apart();
  return moved.far() && can_tell_in_between(moved);
}

// Far from the origin, positions in between may be off by so much that the grid's steps are wider than
// patches, and then nothing is proven apart.
bool FastCuller::can_tell_in_between(const Moved& moved) const {
  const double off = 0x1p-50 * positions_.largest_in_scene();
  return grid_of(positions_.error_beside(off)).steps() * moved.width >= 1;
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
  const std::uint64_t tests = cull_part();
  if (use_whole_step_) {
    classify_within({0, 1});
    return tests + *(tests_ = run(sink));
  }
  const auto ends = [](const TrianglePair& pair) { return std::pair(pair.a, pair.b); };
  for (TrianglePair& pair : found_.pairs)
    if (pair.b < pair.a) std::swap(pair.a, pair.b);
  std::ranges::sort(found_.pairs, {}, ends);
  const auto same = [&](const TrianglePair& a, const TrianglePair& b) { return ends(a) == ends(b); };
  found_.pairs.erase(std::unique(found_.pairs.begin(), found_.pairs.end(), same), found_.pairs.end());
  for (const TrianglePair& pair : found_.pairs) sink.add(pair.a, pair.b);
  return tests;
}

// Collects the pairs of the part that has been looked at, and returns the number of overlap tests. A part in
// which the surface moves far is halved if its descent and its pairs cost too much.
std::uint64_t FastCuller::cull_part() {
  if (use_whole_step_) return 0;
  const TimeRange part = part_;
  const bool can_split = part.last - part.first > 1.0 / kFinest && move_apart().far();
  const std::uint64_t most = can_split ? options_.long_descent * patch_count() : SharedDescent::kAnyNumber;
  const std::size_t before = found_.pairs.size();
  found_.restart();
  tests_ = run(found_, most);
  found_.flush();
  if (!can_split || *tests_ + kTestsOfPair * found_.count() <= most) {
    use_whole_step_ = found_.pairs.size() > kMostCollected;
    return *tests_;
  }
  found_.pairs.resize(before);
  std::uint64_t tests = std::min(*tests_, most);  // how many more were made depends on the number of threads
  const double middle = (part.first + part.last) / 2;
  for (const TimeRange& half : {TimeRange{part.first, middle}, TimeRange{middle, part.last}}) {
    classify_within(half);
    use_whole_step_ |= !positions_.known();  // every pair of triangles would be collected
    tests += cull_part();
  }
  return tests;
}

// Looks at a part of the interval. Covers stay as they are within an interval.
void FastCuller::classify_within(const TimeRange& part) {
  tests_.reset();
  move_to(part);
  classify_all();
}

// Takes over the positions of a part of the interval.
void FastCuller::move_to(const TimeRange& part) {
  part_ = part;
  if (part.first == 0 && part.last == 1) {
    positions_.update(*motion_, pool_);
  } else if (part.first == 0) {
    positions_.update_beginning(*motion_, part.last, pool_);
  } else {
    const std::span<const Vec3> start = motion_->start(), end = motion_->end();
    Eigen::Array3d largest = Eigen::Array3d::Zero();
    part_start_.resize(start.size()), part_end_.resize(start.size());
    for (std::size_t v = 0; v < start.size(); ++v) {
      const Vec3 way = end[v] - start[v];
      part_start_[v] = start[v] + part.first * way;
      part_end_[v] = part.last == 1 ? end[v] : start[v] + part.last * way;
      largest = largest.max(start[v].array().abs()).max(end[v].array().abs());
    }
    // A position in between, start + t (end - start), rounds three times.
    positions_.update(Motion(part_start_, part_end_), pool_, 0x1p-50 * largest.maxCoeff());
  }
  local_thickness_ = positions_.in_local(thickness_.largest());
  grid_ = grid_of(positions_.error());
}

void FastCuller::forget() {
  near_ = 0;
  if (following_) following_->forget(certificates_);
  tests_.reset();
}

void FastCuller::classify(std::size_t patch) {
  fetch(patch + kAhead);
  const PatchLanes lanes = load(positions_.records(), cut_.tree.patches[patch].vertex);
  bound(patch, lanes);
  certificates_.classify(patch, lanes);
}

inline void FastCuller::bound(std::size_t patch, const PatchLanes& lanes) {
  NodeBounds& bounds = bounds_[static_cast<std::size_t>(cut_.tree.leaf[patch])];
  bounds = grid_.bounds_of(lanes);
  if (!options_.time_linear) bounds = swept(bounds);
}

void FastCuller::fetch(std::size_t patch) const {
  if (patch >= patch_count()) return;
  __builtin_prefetch(&bounds_[static_cast<std::size_t>(cut_.tree.leaf[patch])], 1);
  for (const std::int32_t v : cut_.tree.patches[patch].vertex)
    __builtin_prefetch(&positions_.records()[static_cast<std::size_t>(v)]);
}

}  // namespace cscd::fast
