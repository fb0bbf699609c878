#include "core/fast/certify/certificates.h"

#include <algorithm>
#include <bit>
#include <cassert>

// Nearly all triangles are positive, so the certificates of positive triangles are kept by exception: a
// triangle that is not positive takes the certificate from all triangles around it. Negative triangles are
// rare, so a negative triangle looks whether all triangles around it are negative. In the first cover each
// triangle is certified by itself.
namespace cscd::fast {
namespace {

constexpr std::size_t kRange = 128;  // patches that are certified together, some microseconds of work

std::uint64_t count(unsigned mask) {
  return static_cast<std::uint64_t>(std::popcount(mask));
}

}  // namespace

Certificates::Certificates(const TriangleMesh& mesh, const PatchTree& tree, const Covers& covers,
                           std::vector<CappedClusters> capped)
    : tree_(tree),
      covers_(covers),
      certified_(tree.patches.size()),
      single_triangle_signs_(tree.patches.size()),
      state_((tree.patches.size() + kTogether - 1) / kTogether * kTogether, State::usual),
      label_(tree.nodes.size(), Label{} + kNone),
      capped_(std::move(capped)),
      may_cross_ray_(capped_.empty() ? 0 : tree.patches.size()),
      rings_(mesh, tree) {
  // The first cover holds every triangle; `classify` relies on that.
  assert(std::ranges::find(covers_[0].cluster_of, kNone) == covers_[0].cluster_of.end());
  for (const Patch& patch : tree_.patches)
    patch_.push_back({patch.cluster, tree_.inside[patch_.size()], patch.lanes});
  use_covers(kCovers);
  use_contour_test(!capped_.empty());
}

void Certificates::use_contour_test(bool all) {
  if (all == keeps_all_) return;
  keeps_all_ = all;
  one_is_enough_ = all ? 1 : 0;
  forget();
}

void Certificates::use_covers(std::size_t count) {
  assert(0 < count && count <= kCovers);
  covers_used_ = count;
  counts_ = {};
  for (std::size_t c = 0; c < kCovers; ++c) {
    viewpoint_[c].resize(c < count ? covers_[c].observers.size() : 0);
    counts_.clusters += viewpoint_[c].size();
  }
  forget();
}

// Forgets everything that was certified.
void Certificates::forget() {
  std::fill(certified_.begin(), certified_.end(), std::array<Signs, kCovers>{});
  std::fill_n(state_.begin(), patch_.size(), State::spoiled);
}

void Certificates::resize_first_cover() {
  const std::size_t count = covers_[0].observers.size();
  const std::size_t before = viewpoint_[0].size();
  viewpoint_[0].resize(count);
  counts_.clusters += count - before;
  if (!capped_.empty()) capped_[0].resize(count);
}

void Certificates::relabel(std::size_t first, std::size_t last) {
  for (std::size_t p = first; p < last; ++p) {
    patch_[p].cluster[0] = tree_.patches[p].cluster[0];
    state_[p] = State::spoiled;
  }
  rings_.forget_clusters();
}

void Certificates::set_cluster(std::size_t cluster, CapBuilder& builder, const TriangleMesh& mesh,
                               std::span<const TriangleId> triangles, std::span<const TriangleId> targets,
                               std::span<const Vec3> positions) {
  if (!capped_.empty())
    capped_[0].set_cluster(cluster, builder, mesh, triangles, targets, positions,
                           covers_[0].observers[cluster]);
}

std::size_t Certificates::orientation_passes() const {
  std::size_t looks = 0;
  for (const PatchRecord& cell : patch_)
    for (std::size_t c = 0; c < covers_used_; ++c) looks += cell.cluster[c] != kNone;
  return looks;
}

void Certificates::start(const LocalPositions& positions, const ThreadPool& pool, float thickness) {
  positions_ = &positions;
  thickness_ = thickness;
  if (thickness_ > 0) rings_.start(covers_used_);
  place_viewpoints(positions.records());
  for (std::size_t c = 0; keeps_all_ && c < covers_used_; ++c)
    capped_[c].start(positions, viewpoint_[c], pool);
}

void Certificates::finish(const ThreadPool& pool) {
  if (keeps_all_)
    certify_clear(pool);
  else
    certify_all_round();
  if (thickness_ > 0 && keeps_all_) keep_clear_one_rings();
  if (thickness_ > 0 && !keeps_all_) rings_.find_unsettled();
  if (!positions_->known()) forget();
  label_nodes(pool);
}

void Certificates::place_viewpoints(std::span<const LocalPositions::Record> records) {
  for (std::size_t c = 0; c < covers_used_; ++c)
    for (std::size_t i = 0; i < viewpoint_[c].size(); ++i) {
      Viewpoint& viewpoint = viewpoint_[c][i];
      viewpoint = placed(covers_[c].observers[i], records);
      viewpoint.reach = reach_of(viewpoint, positions_->error());
    }
}

void Certificates::classify(std::size_t p, const PatchLanes& lanes) {
  const Patch& patch = tree_.patches[p];
  const Viewpoint* from[kCovers] = {};
  for (std::size_t c = 0; c < covers_used_; ++c)
    if (patch.cluster[c] != kNone) from[c] = &viewpoint_[c][static_cast<std::size_t>(patch.cluster[c])];
  Signs seen[kCovers];
  if (thickness_ > 0)
    classify_at_distance(p, lanes, from, seen);
  else
    orientations(lanes, patch, from, positions_->error(), seen);
  if (keeps_all_) {
    may_cross_ray_[p] = 0;
    for (std::size_t c = 0; c < covers_used_; ++c)
      if (from[c] != nullptr && capped_[c].may_cross_ray(static_cast<std::size_t>(patch.cluster[c]), lanes))
        may_cross_ray_[p] |= static_cast<std::uint8_t>(1U << c);
  }
  bool usual = true;
  for (std::size_t c = 0; c < covers_used_; ++c)
    usual &= from[c] == nullptr || (patch.lanes & ~static_cast<unsigned>(seen[c].positive)) == 0;
  if (usual) return make_usual(p);
  state_[p] = State::seen;
  for (std::size_t c = 0; c < covers_used_; ++c)
    if (from[c] != nullptr)
      single_triangle_signs_[p][c] = {
          static_cast<Mask16>(patch.lanes & ~static_cast<unsigned>(seen[c].positive)),
          static_cast<Mask16>(patch.lanes & seen[c].negative)};
  // The first cover holds every triangle. The other covers certify the patch unless `finish` finds a triangle
  // around it that is not positive.
  certified_[p][0] = {static_cast<Mask16>(patch.lanes & seen[0].positive),
                      single_triangle_signs_[p][0].negative};
  for (std::size_t c = 1; c < covers_used_; ++c) certified_[p][c] = {patch_[p].inside[c], 0};
}

// By signs, planes have to be farther away than half of the thickness. Caps go by signs alone, and by the
// heights of what is clear.
void Certificates::classify_at_distance(std::size_t p, const PatchLanes& lanes,
                                        const Viewpoint* const (&from)[kCovers], Signs (&seen)[kCovers]) {
  DistantSigns distant;
  orientations_at_distance(lanes, tree_.patches[p], from, positions_->error(),
                           keeps_all_ ? 0 : thickness_ / 2, thickness_, distant);
  for (std::size_t c = 0; c < kCovers; ++c) {
    seen[c] = distant.signs[c];
    rings_.take(p, c, distant.tall[c]);
  }
}

// With a thickness, a triangle is certified only if all triangles round its corners are clear and tall.
void Certificates::keep_clear_one_rings() {
  for (std::size_t p = 0; p < patch_.size(); ++p)
    for (std::size_t c = 0; c < covers_used_; ++c)
      rings_.spoil(p, c,
                   static_cast<Mask16>(patch_[p].lanes & ~static_cast<unsigned>(certified_[p][c].positive)));
  rings_.find_one_rings();
  for (std::size_t p = 0; p < patch_.size(); ++p)
    for (std::size_t c = 0; c < covers_used_; ++c) {
      if (patch_[p].cluster[c] == kNone) continue;
      const Mask16 kept = certified_[p][c].positive & rings_.one_rings(p, c);
      if (kept == certified_[p][c].positive) continue;
      certified_[p][c].positive = kept;
      if (state_[p] != State::seen) state_[p] = State::spoiled;
    }
}

void Certificates::make_usual(std::size_t p) {
  if (state_[p] == State::usual) return;
  state_[p] = State::unlabelled;
  single_triangle_signs_[p] = {};
  certified_[p] = {};
  certified_[p][0].positive = patch_[p].lanes;
  for (std::size_t c = 1; c < covers_used_; ++c)
    certified_[p][c].positive = !keeps_all_                     ? patch_[p].inside[c]
                                : patch_[p].cluster[c] != kNone ? patch_[p].lanes
                                                                : Mask16{0};
}

void Certificates::certify_all_round() {
  for_each_unusual([&](std::size_t p) {
    if (state_[p] == State::seen) certify_by_rings(p);
  });
}

// A cover other than the first certifies a triangle only if every triangle round its corners is positive too,
// or every one is negative. This recomputes the certificates of one patch that is not all positive by itself.
void Certificates::certify_by_rings(std::size_t p) {
  const Patch& patch = tree_.patches[p];
  Mask16 corners[kCovers] = {}, not_negative[kCovers] = {};  // places of vertices in the patch
  unsigned any = 0;
  for (std::size_t c = 1; c < covers_used_; ++c)
    any |= corners[c] = patch.corners_of(single_triangle_signs_[p][c].not_positive);
  if (any == 0) return;
  tree_.for_each_adjacent(p, [&](std::size_t q, const SharedVertices& common) {
    if (state_[q] != State::seen) state_[q] = State::spoiled;
    for (std::size_t c = 1; c < covers_used_; ++c) {
      certified_[q][c].positive &= static_cast<Mask16>(~common.lanes(corners[c]));
      not_negative[c] |= common.places(static_cast<Mask16>(~single_triangle_signs_[q][c].negative));
    }
  });
  for (std::size_t c = 1; c < covers_used_; ++c)
    for_each_lane(single_triangle_signs_[p][c].negative & patch_[p].inside[c], [&](std::size_t lane) {
      if ((patch.corners_of(1U << lane) & not_negative[c]) == 0)
        certified_[p][c].negative |= static_cast<Mask16>(1U << lane);
    });
}

// Returns the triangles of a patch that are positive by themselves in one cover.
Mask16 Certificates::positive(std::size_t p, std::size_t c) const {
  return state_[p] == State::seen
             ? static_cast<Mask16>(patch_[p].lanes &
                                   ~static_cast<unsigned>(single_triangle_signs_[p][c].not_positive))
             : patch_[p].lanes;
}

void Certificates::certify_clear(const ThreadPool& pool) {
  pool.parallel_for(covers_used_, [&](std::size_t cover, std::size_t) { take_all(cover); });
  pool.ranges(patch_.size(), kRange, [&](std::size_t first, std::size_t last, std::size_t) {
    for (std::size_t p = first; p < last; ++p) certify_clear(p);
  });
}

// Tells the capped clusters of a cover which triangles are not positive, and which their rays may cross.
void Certificates::take_all(std::size_t c) {
  for (std::size_t p = 0; p < patch_.size(); ++p)
    if ((state_[p] == State::seen || may_cross_ray_[p] != 0) && patch_[p].cluster[c] != kNone &&
        (positive(p, c) != patch_[p].lanes || (may_cross_ray_[p] >> c & 1) != 0))
      capped_[c].take(tree_.patches[p], positive(p, c));
  while (capped_[c].choose_other_rays())
    for (std::size_t p = 0; p < patch_.size(); ++p)
      if (patch_[p].cluster[c] != kNone &&
          capped_[c].has_other_ray(static_cast<std::size_t>(patch_[p].cluster[c])))
        capped_[c].count(tree_.patches[p], positive(p, c));
}

void Certificates::certify_clear(std::size_t p) {
  const auto cluster = [&](std::size_t c) { return static_cast<std::size_t>(patch_[p].cluster[c]); };
  bool all_clear = state_[p] != State::seen;
  for (std::size_t c = 0; c < covers_used_; ++c)
    all_clear &= patch_[p].cluster[c] == kNone || capped_[c].all_clear(cluster(c));
  if (all_clear) return;
  for (std::size_t c = 0; c < covers_used_; ++c)
    if (patch_[p].cluster[c] != kNone)
      certified_[p][c] = {capped_[c].clear(tree_.patches[p], positive(p, c)), 0};
  if (state_[p] != State::seen) state_[p] = State::spoiled;
}

void Certificates::label_nodes(const ThreadPool& pool) {
  counts_.positive = covers_[0].cluster_of.size();
  counts_.negative = counts_.uncertain = 0;
  for_each_unusual([&](std::size_t p) {
    const PatchRecord& patch = patch_[p];
    unsigned some = 0;
    Label label = Label{} + kNone;
    for (std::size_t c = 0; c < kCovers; ++c) {
      const Signs& signs = certified_[p][c];
      label[c] = patch.cluster[c] == kNone                              ? kNone
                 : signs.positive == patch.lanes                        ? 2 * patch.cluster[c]
                 : signs.negative == patch.lanes || one_is_enough_ != 0 ? 2 * patch.cluster[c] + 1
                                                                        : kNone;
      some |= signs.positive | signs.negative;
    }
    label_[static_cast<std::size_t>(tree_.leaf[p])] = label;
    counts_.positive -= count(patch.lanes & ~static_cast<unsigned>(certified_[p][0].positive));
    counts_.negative += count(certified_[p][0].negative);
    counts_.uncertain += count(patch.lanes & ~some);
    if (state_[p] == State::unlabelled) state_[p] = State::usual;
  });
  // Recompute the labels of all inner nodes, although few have changed: the descent reads most of them soon,
  // and this pass brings them into the cache.
  tree_.for_each_inner_upwards(pool, [&](std::size_t n, const PatchTree::Node& node) {
    const Label left = label_[node.left()], right = label_[node.right()];
    label_[n] = (left ^ right) >> one_is_enough_ == 0 ? left | right : Label{} + kNone;
  });
}

RadialView Certificates::view() const {
  const std::size_t triangles = covers_[0].cluster_of.size();
  RadialView view{covers_[0].cluster_of, std::vector<bool>(triangles), observers(0)};
  for (std::size_t c = 1; c < covers_used_; ++c)
    view.further_covers.push_back({covers_[c].cluster_of, observers(c)});
  view.patch.resize(triangles);
  for (std::size_t p = 0; p < certified_.size(); ++p) {
    for (const TriangleId t : tree_.triangles_of(p)) view.patch[+t] = static_cast<std::int32_t>(p);
    for_each_lane(certified_[p][0].positive,
                  [&](std::size_t lane) { view.positive[+tree_.triangles[p][lane]] = true; });
  }
  return view;
}

std::vector<RadialView::Observer> Certificates::observers(std::size_t cover) const {
  std::vector<RadialView::Observer> observers;
  for (const Viewpoint& viewpoint : viewpoint_[cover]) {
    const MovingPoint at{positions_->in_scene(viewpoint.at[0], 0), positions_->in_scene(viewpoint.at[1], 1)};
    observers.push_back({static_cast<std::int32_t>(observers.size()), at, at});
  }
  return observers;
}

}  // namespace cscd::fast
