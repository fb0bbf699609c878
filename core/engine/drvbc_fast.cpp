#include "core/engine/drvbc_fast.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <numbers>

#include "core/base/stage_clock.h"
#include "core/detect/compose.h"
#include "core/engine/certificates.h"
#include "core/engine/stars.h"
#include "core/mesh/adjacency.h"
#include "core/radial/distance_field.h"
#include "core/radial/observer.h"
#include "core/radial/refinement.h"
#include "core/radial/segmentation.h"
#include "core/radial/setup.h"

// Radial view based culling after the paper (drvbc.cpp), taken further: one tree over patches of sixteen
// triangles; two covers whose seams lie inside each other's clusters instead of mega clusters
// (certificates.h); bounds of both ends of the interval instead of whole paths (patch_lanes.h); stars of
// vertices for the neighbours that are left (stars.h). What a "no" proves stands there.
//
// A pass over all vertices, two over all patches, and a descent that meets what no cover certifies.
namespace cscd {
namespace fast {
namespace {

class FastCuller : public Culler {
 public:
  FastCuller(const Setup& setup, Covers covers, const DrvbcFastOptions& options)
      : mesh_(setup.mesh),
        covers_(std::move(covers)),
        options_(options),
        positions_(setup.reference),
        tree_(make_patches(setup.mesh, setup.reference, covers_)),
        certificates_(tree_, covers_, options.second_cover ? kCovers : 1),
        stars_(setup.mesh),
        lanes_(tree_.patches.size()),
        bounds_(tree_.nodes.size()),
        triangle_bounds_at_(tree_.patches.size(), kNone) {}

  void refit(const Motion& motion) override {
    positions_.update(motion);
    std::size_t patch = tree_.patches.size();
    for (std::size_t n = tree_.nodes.size(); n-- > 0;) {
      const PatchTree::Node& node = tree_.nodes[n];
      if (node.is_leaf()) {
        --patch;
        lanes_[patch] = load(positions_.records(), tree_.patches[patch].vertex);
        bounds_[n] = bounds_of(lanes_[patch], positions_.error());
        if (!options_.time_linear) sweep(bounds_[n]);
      } else {
        bounds_[n] = united(bounds_[n + 1], bounds_[static_cast<std::size_t>(node.right)]);
      }
    }
    if (!positions_.known())  // everything overlaps
      for (MovingBounds& b : bounds_)
        for (Float16& end : b.at) end = Float16{} - std::numeric_limits<float>::infinity();
  }

  bool classify(const Motion&, const Rig::Interval*) override {
    certificates_.update(positions_, lanes_);
    return true;
  }

  CullCounts cull(TrianglePairSink& sink) override {
    sink_ = &sink;
    tests_ = 0;
    triangle_bounds_used_ = 0;
    std::fill(triangle_bounds_at_.begin(), triangle_bounds_at_.end(), kNone);
    stars_.start_interval(positions_);
    self(0);
    CullCounts counts;
    counts.bvot = tests_;
    counts.radial = certificates_.counts();
    return counts;
  }

  RadialView radial_view() const override { return certificates_.view(); }

 private:
  static void sweep(MovingBounds& b) { b.at[0] = b.at[1] = smaller(b.at[0], b.at[1]); }

  void self(std::size_t n) {
    if (certificates_.skip(n, n)) return;
    const PatchTree::Node& node = tree_.nodes[n];
    if (node.is_leaf()) return inside(node.patch());
    const auto right = static_cast<std::size_t>(node.right);
    self(n + 1);
    self(right);
    pair(n + 1, right);
  }

  void pair(std::size_t a, std::size_t b) {
    if (certificates_.skip(a, b)) return;
    ++tests_;
    if (!apart(bounds_[a], bounds_[b])) below(a, b);
  }

  void below(std::size_t a, std::size_t b) {
    const PatchTree::Node &first = tree_.nodes[a], &second = tree_.nodes[b];
    if (first.is_leaf() && second.is_leaf()) return between(a, b);
    const std::size_t of_a[2] = {first.is_leaf() ? a : a + 1, static_cast<std::size_t>(first.right)};
    const std::size_t of_b[2] = {second.is_leaf() ? b : b + 1, static_cast<std::size_t>(second.right)};
    for (std::size_t i = 0; i < (first.is_leaf() ? 1 : 2); ++i)
      for (std::size_t j = 0; j < (second.is_leaf() ? 1 : 2); ++j) pair(of_a[i], of_b[j]);
  }

  // Pairs inside one patch.
  void inside(std::size_t p) {
    const Certificates::Shared shared = certificates_.shared(p, p);
    const Adjacent* adjacent = tree_.adjacent_to(p, p);
    const Mask16 lanes = tree_.patches[p].lanes;
    for (std::size_t lane = 0; lanes >> lane > 1; ++lane)
      row(p, lane, p, static_cast<Mask16>(shared.needed(lane) & ~((2U << lane) - 1)), adjacent);
  }

  // Pairs between the patches of two leaves: those triangles of each that meet the other's bounds.
  void between(std::size_t a, std::size_t b) {
    const std::size_t p = tree_.nodes[a].patch(), q = tree_.nodes[b].patch();
    const Certificates::Shared shared = certificates_.shared(p, q);
    Mask16 rows = tree_.patches[p].lanes, columns = tree_.patches[q].lanes;
    for (std::size_t s = 0; s < shared.p.size(); ++s) {  // what all of the other patch drops
      if (shared.q[s] == tree_.patches[q].lanes) rows &= static_cast<Mask16>(~shared.p[s]);
      if (shared.p[s] == tree_.patches[p].lanes) columns &= static_cast<Mask16>(~shared.q[s]);
    }
    if (rows == 0 || columns == 0) return;
    rows = near_counted(bounds_of_triangles(p), rows, bounds_[b]);
    if (rows == 0) return;
    columns = near_counted(bounds_of_triangles(q), columns, bounds_[a]);
    if (columns == 0) return;
    const Adjacent* adjacent = tree_.adjacent_to(p, q);
    for (unsigned rest = rows; rest != 0; rest &= rest - 1) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
      row(p, lane, q, static_cast<Mask16>(shared.needed(lane) & columns), adjacent);
    }
  }

  // One triangle of patch p against some of patch q.
  void row(std::size_t p, std::size_t lane, std::size_t q, Mask16 wanted, const Adjacent* adjacent) {
    if (wanted == 0) return;
    if (adjacent != nullptr) {
      const auto beside = static_cast<Mask16>(wanted & adjacent->lanes[lane]);
      wanted &= static_cast<Mask16>(~beside);
      take_adjacent(p, lane, q, beside);
      if (wanted == 0) return;
    }
    bounds_of_triangles(p);  // before a reference is taken, as they are made on demand
    const TriangleBounds& others = bounds_of_triangles(q);
    tests_ += static_cast<unsigned>(std::popcount(wanted));
    if (positions_.known()) wanted = near(others, wanted, bounds_of_triangles(p), lane);
    for (unsigned rest = wanted; rest != 0; rest &= rest - 1)
      sink_->add(tree_.patches[p].triangle[lane],
                 tree_.patches[q].triangle[static_cast<std::size_t>(std::countr_zero(rest))]);
  }

  // Adjacent triangles always overlap: they are passed on untested, unless a star proves them apart.
  void take_adjacent(std::size_t p, std::size_t lane, std::size_t q, Mask16 lanes) {
    const TriangleId t = tree_.patches[p].triangle[lane];
    for (unsigned rest = lanes; rest != 0; rest &= rest - 1) {
      const TriangleId u = tree_.patches[q].triangle[static_cast<std::size_t>(std::countr_zero(rest))];
      if (!options_.stars || !in_flat_star(t, u)) sink_->add(t, u);
    }
  }

  bool in_flat_star(TriangleId t, TriangleId u) {
    const Triangle &a = mesh_.corners(t), &b = mesh_.corners(u);
    return std::any_of(a.begin(), a.end(), [&](VertexId v) { return contains(b, v) && stars_.flat(v); });
  }

  Mask16 near_counted(const TriangleBounds& triangles, Mask16 mask, const MovingBounds& other) {
    if (!positions_.known()) return mask;
    tests_ += static_cast<unsigned>(std::popcount(mask));
    return near(triangles, mask, other);
  }

  const TriangleBounds& bounds_of_triangles(std::size_t p) {
    std::int32_t& at = triangle_bounds_at_[p];
    if (at == kNone) {
      if (triangle_bounds_used_ == triangle_bounds_.size()) triangle_bounds_.emplace_back();
      at = static_cast<std::int32_t>(triangle_bounds_used_++);
      TriangleBounds& bounds = triangle_bounds_[static_cast<std::size_t>(at)];
      bounds = triangle_bounds(lanes_[p], tree_.patches[p], positions_.error());
      if (!options_.time_linear)
        for (std::size_t k = 0; k < kDirections; ++k) {
          bounds.low[k][0] = bounds.low[k][1] = smaller(bounds.low[k][0], bounds.low[k][1]);
          bounds.high[k][0] = bounds.high[k][1] = larger(bounds.high[k][0], bounds.high[k][1]);
        }
    }
    return triangle_bounds_[static_cast<std::size_t>(at)];
  }

  const TriangleMesh& mesh_;
  Covers covers_;
  DrvbcFastOptions options_;
  LocalPositions positions_;
  PatchTree tree_;
  Certificates certificates_;
  Stars stars_;
  std::vector<PatchLanes> lanes_;                 // of each patch
  std::vector<MovingBounds> bounds_;              // of each node
  std::vector<std::int32_t> triangle_bounds_at_;  // of each patch: where among those below, made on demand
  std::vector<TriangleBounds> triangle_bounds_;
  std::size_t triangle_bounds_used_ = 0;
  TrianglePairSink* sink_ = nullptr;
  std::uint64_t tests_ = 0;
};

// As in drvbc.
radial::AtomicClusters refined_clusters(const Setup& setup, std::vector<BoneId> bone_of) {
  const radial::AtomicClusters clusters = radial::make_atomic_clusters(setup.mesh, bone_of);
  const std::vector<radial::ObserverKind> kinds = radial::choose_by_rotation_trial(
      setup.mesh, setup.reference, *setup.rig, clusters, 10 * std::numbers::pi / 180);
  bone_of = radial::refine_by_orientation(setup.mesh, setup.reference, *setup.rig, clusters, kinds);
  return radial::make_atomic_clusters(setup.mesh, bone_of);
}

}  // namespace
}  // namespace fast

Prepared make_drvbc_fast(const Setup& setup, const DrvbcFastOptions& options) {
  radial::require_radial_setup(setup, std::string(options.name));
  StageClock clock;
  clock.enter(Stage::distance_and_heat);
  const int full = radial::resolution_of_mean_edge(setup.mesh, setup.reference);
  std::vector<BoneId> bone_of =
      radial::nearest_bone_by_heat(setup.mesh, setup.reference, *setup.rig, {std::max(1, full / 4), 5});
  clock.enter(Stage::decomposition);
  const radial::AtomicClusters clusters = fast::refined_clusters(setup, std::move(bone_of));
  fast::Covers covers = fast::make_covers(setup.mesh, setup.reference, clusters);
  auto culler = std::make_unique<fast::FastCuller>(setup, std::move(covers), options);
  clock.stop();
  Preparation preparation{clock.milliseconds(Stage::distance_and_heat),
                          clock.milliseconds(Stage::decomposition), clusters.of_triangle,
                          static_cast<int>(clusters.clusters.size())};
  return {compose(std::move(culler), setup.mesh, setup.elementary), preparation};
}

}  // namespace cscd
