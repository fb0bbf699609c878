#include "core/fast/fast_culler.h"

#include <algorithm>
#include <utility>

namespace cscd::fast {
namespace {

constexpr std::size_t kRange = 512;           // patches that are looked at together, 20 microseconds of work
constexpr std::size_t kCappedRange = 128;     // patches where caps are looked at too
constexpr std::size_t kAhead = 2;             // positions are fetched so many patches before the look
constexpr std::size_t kSampled = 256;         // about so many patches are asked how far they move
constexpr std::size_t kWorthStopping = 1024;  // patches; the descent of fewer is too short to be stopped
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
      stars_(setup.mesh),
      team_(setup.threads),
      descent_({cut_.tree, positions_, certificates_, options.stars ? &stars_ : nullptr, options.time_linear,
                options.planes},
               team_),
      bounds_(cut_.tree.nodes.size()) {
  use_covers(options.covers);
}

void FastCuller::refit(const Step& step) {
  motion_ = step.motion;
  thickness_ = step.thickness;
  last_ = 1;
  positions_.update(step.motion, team_);
  local_thickness_ = positions_.in_local(thickness_.largest());
  grid_ = grid_of(positions_.error());
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
  certificates_.start(positions_, team_, local_thickness_);
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
  refit({.motion = *motion_, .thickness = thickness_});
  look_at(*motion_);
  return descend(sink);
}

// Passes on the pairs of the interval that has been looked at, and returns the number of overlap tests.
std::uint64_t FastCuller::descend(TrianglePairSink& sink) {
  if (options_.long_descent != DrvbcFastOptions::kNever && positions_.known()) {
    const Moved moved = move_apart();
    if (moved.far() && can_tell_in_between(moved)) {
      if (!sink.may_close()) {
        rounding_ = error_in_between();
        return cull_parts(sink, false);
      }
      const std::uint64_t most = options_.long_descent * patch_count();
      tests_ = run_until_closed(sink, most);
      const std::uint64_t tests = *tests_;
      if (sink.closed() || tests <= most) return tests;
      sink.begin_again();
      rounding_ = error_in_between();
      return tests + cull_parts(sink, true);
    }
  }
  const bool may_stop = sink.may_close() && patch_count() >= kWorthStopping;
  return *(tests_ = may_stop ? run_until_closed(sink) : run(sink));
}

std::uint64_t FastCuller::run(TrianglePairSink& sink, std::uint64_t most) {
  pass_on_near(sink);
  return descent_.run(bounds_, grid_, sink, most);
}

std::uint64_t FastCuller::run_until_closed(TrianglePairSink& sink, std::uint64_t most) {
  pass_on_near(sink);
  return descent_.run_until_closed(bounds_, grid_, sink, most);
}

// Passes on the pairs near on the surface of which signs say nothing (certify/tall_rings.h).
void FastCuller::pass_on_near(TrianglePairSink& sink) const {
  certificates_.for_each_unsettled_pair([&](TriangleId a, TriangleId b) { sink.add(a, b); });
}

// Returns by how much a position in between, start + t (end - start), may be off: it rounds three times.
double FastCuller::error_in_between() const {
  return 0x1p-50 * positions_.largest_in_scene();
}

// Far from the origin, positions in between may be off by so much that the grid's steps are wider than
// patches, and then nothing is proven apart.
bool FastCuller::can_tell_in_between(const Moved& moved) const {
  return grid_of(positions_.error_beside(error_in_between())).steps() * moved.width >= 1;
}

bool FastCuller::can_shorten() const {
  return options_.long_descent != DrvbcFastOptions::kNever && positions_.known() &&
         can_tell_in_between(move_apart());
}

void FastCuller::shorten(double last) {
  rounding_ = error_in_between();
  last_ = last;
  tests_.reset();  // covers stay as they are within an interval
  begin({0, kFinest});
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

// The parts pass on a pair of triangles again and again, so pairs are collected first: from all parts, or,
// where the sink may close, up to the first part after which it needs no more. `is_long` says that the
// descent of the whole interval is known to be long.
std::uint64_t FastCuller::cull_parts(TrianglePairSink& sink, bool is_long) {
  found_.pairs.clear();
  passed_on_ = 0;
  use_whole_step_ = enough_ = false;
  const Part whole{0, kFinest};
  const std::uint64_t tests = is_long ? cull_halves(whole, sink) : cull_part(whole, sink);
  if (use_whole_step_) {
    if (last_ == 1) rounding_ = 0;  // both ends of the interval are given
    begin(whole);
    sink.begin_again();
    return tests + *(tests_ = run(sink));
  }
  pass_on_new(sink);
  return tests;
}

// Passes on the pairs that were found since the last call and that were not found before. Those that have
// been passed on are sorted, at the front.
void FastCuller::pass_on_new(TrianglePairSink& sink) {
  const auto ends = [](const TrianglePair& pair) { return std::pair(pair.a, pair.b); };
  const auto same = [&](const TrianglePair& a, const TrianglePair& b) { return ends(a) == ends(b); };
  std::vector<TrianglePair>& pairs = found_.pairs;
  const auto first_new = pairs.begin() + static_cast<std::ptrdiff_t>(passed_on_);
  std::for_each(first_new, pairs.end(), [](TrianglePair& pair) {
    if (pair.b < pair.a) std::swap(pair.a, pair.b);
  });
  std::ranges::sort(first_new, pairs.end(), {}, ends);
  pairs.erase(std::unique(first_new, pairs.end(), same), pairs.end());
  const auto known = [&](const TrianglePair& pair) {
    return std::ranges::binary_search(pairs.begin(), first_new, ends(pair), {}, ends);
  };
  pairs.erase(std::remove_if(first_new, pairs.end(), known), pairs.end());
  std::for_each(first_new, pairs.end(), [&](const TrianglePair& pair) { sink.add(pair.a, pair.b); });
  std::ranges::inplace_merge(pairs.begin(), first_new, pairs.end(), {}, ends);
  passed_on_ = pairs.size();
}

// Collects the pairs of a part that has been looked at, and returns the number of overlap tests. A part in
// which the surface moves far is halved if its descent and its pairs cost too much.
std::uint64_t FastCuller::cull_part(const Part& part, TrianglePairSink& sink) {
  if (use_whole_step_ || enough_) return 0;
  const bool can_split = part.last - part.first > 1 && move_apart().far();
  const std::uint64_t most = can_split ? options_.long_descent * patch_count() : SharedDescent::kAnyNumber;
  const std::size_t before = found_.pairs.size();
  found_.restart();
  tests_ = run(found_, most);
  found_.flush();
  if (!can_split || *tests_ + kTestsOfPair * found_.count() <= most) {
    use_whole_step_ = found_.pairs.size() > kMostCollected;
    if (sink.may_close() && !use_whole_step_) {
      pass_on_new(sink);
      enough_ = sink.is_enough(last_ * part.last / kFinest);
    }
    return *tests_;
  }
  found_.pairs.resize(before);
  return std::min(*tests_, most)  // how many more were made depends on the number of threads
         + cull_halves(part, sink);
}

std::uint64_t FastCuller::cull_halves(const Part& part, TrianglePairSink& sink) {
  std::uint64_t tests = 0;
  tests_.reset();
  const unsigned middle = (part.first + part.last) / 2;
  for (const Part& half : {Part{part.first, middle}, Part{middle, part.last}}) {
    if (enough_) break;
    begin(half);
    use_whole_step_ |= !positions_.known();  // every pair of triangles would be collected
    tests += cull_part(half, sink);
  }
  return tests;
}

// Looks at a part of the interval.
void FastCuller::begin(const Part& part) {
  const std::span<const Vec3> start = motion_->start(), end = motion_->end();
  const auto at = [&](unsigned time, std::vector<Vec3>& positions) {
    if (time == 0) return start;
    if (time == kFinest && last_ == 1) return end;
    positions.resize(start.size());
    const double t = last_ * time / kFinest;
    for (std::size_t v = 0; v < start.size(); ++v) positions[v] = start[v] + t * (end[v] - start[v]);
    return std::span<const Vec3>(positions);
  };
  const Motion motion(at(part.first, part_start_), at(part.last, part_end_));
  positions_.update(motion, team_, rounding_);
  grid_ = grid_of(positions_.error());
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
