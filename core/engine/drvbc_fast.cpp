#include "core/engine/drvbc_fast.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <numbers>

#include "core/base/stage_clock.h"
#include "core/detect/compose.h"
#include "core/engine/certificates.h"
#include "core/engine/node_bounds.h"
#include "core/engine/stars.h"
#include "core/engine/surface_clusters.h"
#include "core/engine/trial_poses.h"
#include "core/radial/distance_field.h"
#include "core/radial/observer.h"
#include "core/radial/refinement.h"
#include "core/radial/segmentation.h"

// Radial view based culling after the paper (drvbc.cpp), taken further: one tree over patches of sixteen
// triangles; covers whose seams lie inside one another's clusters instead of mega clusters
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
      : covers_(std::move(covers)),
        options_(options),
        positions_(setup.reference),
        tree_(make_patches(setup.mesh, setup.reference, covers_)),
        certificates_(tree_, covers_, options.covers),
        stars_(setup.mesh),
        bounds_(tree_.nodes.size()),
        triangle_bounds_at_(tree_.patches.size(), kNone) {}

  void refit(const Motion& motion) override {
    positions_.update(motion);
    grid_ = Grid(positions_.error());
  }

  // Bounds too, as a patch is loaded once for both.
  bool classify(const Motion&, const Rig::Interval*) override {
    certificates_.start(positions_);
    for (std::size_t n = tree_.nodes.size(); n-- > 0;) {
      const PatchTree::Node& node = tree_.nodes[n];
      if (node.is_leaf()) {
        const PatchLanes lanes = load(positions_.records(), tree_.patches[node.patch()].vertex);
        bounds_[n] = grid_.bounds_of(lanes);
        if (!options_.time_linear) bounds_[n] = swept(bounds_[n]);
        certificates_.look(node.patch(), lanes);
      } else {
        bounds_[n] = united(bounds_[node.left()], bounds_[node.right()]);
      }
    }
    certificates_.finish();
    if (!positions_.known()) std::fill(bounds_.begin(), bounds_.end(), unbounded());
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
  std::size_t patch_count() const { return tree_.patches.size(); }

 private:
  void self(std::size_t n) {
    if (certificates_.skip(n, n)) return;
    const PatchTree::Node& node = tree_.nodes[n];
    if (node.is_leaf()) return inside(node.patch());
    self(node.left());
    self(node.right());
    pair(node.left(), node.right());
  }

  void pair(std::size_t a, std::size_t b) { step<1, 1>(a, b); }

  void below(std::size_t a, std::size_t b) {
    const PatchTree::Node first = tree_.nodes[a], second = tree_.nodes[b];
    if (!first.is_leaf() && !second.is_leaf()) return step<2, 2>(first.left(), second.left());
    if (!first.is_leaf()) return step<2, 1>(first.left(), b);
    if (!second.is_leaf()) return step<1, 2>(a, second.left());
    between(a, b);
  }

  // One node or two siblings against one or two. All are tested before any is descended into.
  template <std::size_t kA, std::size_t kB>
  void step(std::size_t a, std::size_t b) {
    unsigned open = 0;
    for (std::size_t i = 0; i < kA; ++i)
      for (std::size_t j = 0; j < kB; ++j) {
        const bool asked = !certificates_.skip(a + i, b + j);
        tests_ += asked;
        open |= static_cast<unsigned>(asked & !apart(bounds_[a + i], bounds_[b + j])) << (i * kB + j);
      }
    for (; open != 0; open &= open - 1) {
      const auto k = static_cast<std::size_t>(std::countr_zero(open));
      below(a + k / kB, b + k % kB);
    }
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
    rows = near_counted(bounds_of_triangles(p), rows, grid_.in_units(bounds_[b]));
    if (rows == 0) return;
    columns = near_counted(bounds_of_triangles(q), columns, grid_.in_units(bounds_[a]));
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
      wanted = not_flat(p, lane, wanted, adjacent->sharing[lane]);
      // Adjacent triangles always overlap: they are passed on untested.
      const auto beside = static_cast<Mask16>(wanted & adjacent->lanes(lane));
      wanted &= static_cast<Mask16>(~beside);
      pass_on(p, lane, q, beside);
      if (wanted == 0) return;
    }
    bounds_of_triangles(p);  // before a reference is taken, as they are made on demand
    const TriangleBounds& others = bounds_of_triangles(q);
    tests_ += static_cast<unsigned>(std::popcount(wanted));
    if (positions_.known()) wanted = near(others, wanted, bounds_of_triangles(p), lane);
    pass_on(p, lane, q, wanted);
  }

  // Without the pairs that the star of a common corner proves apart. `sharing`: those with each corner.
  Mask16 not_flat(std::size_t p, std::size_t lane, Mask16 wanted, const std::array<Mask16, 3>& sharing) {
    if (!options_.stars) return wanted;
    const Patch& patch = tree_.patches[p];
    for (std::size_t k = 0; k < 3; ++k)
      if ((wanted & sharing[k]) != 0 && stars_.flat(VertexId{patch.vertex[patch.corner[k][lane]]}))
        wanted &= static_cast<Mask16>(~sharing[k]);
    return wanted;
  }

  void pass_on(std::size_t p, std::size_t lane, std::size_t q, Mask16 lanes) {
    for (unsigned rest = lanes; rest != 0; rest &= rest - 1)
      sink_->add(tree_.patches[p].triangle[lane],
                 tree_.patches[q].triangle[static_cast<std::size_t>(std::countr_zero(rest))]);
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
      bounds = triangle_bounds(load(positions_.records(), tree_.patches[p].vertex), tree_.patches[p],
                               positions_.error());
      if (!options_.time_linear)
        for (std::size_t k = 0; k < kDirections; ++k) {
          bounds.low[k][0] = bounds.low[k][1] = smaller(bounds.low[k][0], bounds.low[k][1]);
          bounds.high[k][0] = bounds.high[k][1] = larger(bounds.high[k][0], bounds.high[k][1]);
        }
    }
    return triangle_bounds_[static_cast<std::size_t>(at)];
  }

  Covers covers_;
  DrvbcFastOptions options_;
  LocalPositions positions_;
  PatchTree tree_;
  Certificates certificates_;
  Stars stars_;
  Grid grid_{1};
  std::vector<NodeBounds> bounds_;                // of each node
  std::vector<std::int32_t> triangle_bounds_at_;  // of each patch: where among those below, made on demand
  std::vector<TriangleBounds> triangle_bounds_;
  std::size_t triangle_bounds_used_ = 0;
  TrianglePairSink* sink_ = nullptr;
  std::uint64_t tests_ = 0;
};

bool has_bones(const Setup& setup) {
  return setup.rig != nullptr && !setup.rig->parent.empty();
}

// Bones of triangles, made as in drvbc.
std::vector<BoneId> bones_of(const Setup& setup, StageClock& clock) {
  clock.enter(Stage::distance_and_heat);
  const int full = radial::resolution_of_mean_edge(setup.mesh, setup.reference);
  const std::vector<BoneId> bone_of =
      radial::nearest_bone_by_heat(setup.mesh, setup.reference, *setup.rig, {std::max(1, full / 4), 5});
  clock.enter(Stage::decomposition);
  const radial::AtomicClusters clusters = radial::make_atomic_clusters(setup.mesh, bone_of);
  const std::vector<radial::ObserverKind> kinds = radial::choose_by_rotation_trial(
      setup.mesh, setup.reference, *setup.rig, clusters, 10 * std::numbers::pi / 180);
  return radial::refine_by_orientation(setup.mesh, setup.reference, *setup.rig, clusters, kinds);
}

class CountingSink : public TrianglePairSink {
  void take(const std::vector<TrianglePair>&) override {}
};

// Work in overlap tests. About so many cost as much as a patch in an interval, or a pair that is left.
constexpr std::uint64_t kTestsOfPatch = 12, kTestsOfPair = 40;
constexpr std::size_t kTrials = 6;

std::uint64_t work(const Setup& setup, std::span<const std::int32_t> cluster_of,
                   std::span<const Trial> trials) {
  FastCuller culler(setup, make_covers(setup.mesh, setup.reference, cluster_of), {});
  CountingSink sink;
  std::uint64_t tests = trials.size() * kTestsOfPatch * culler.patch_count();
  for (const Trial& trial : trials) {
    const Motion motion(trial[0], trial[1]);
    culler.refit(motion);
    culler.classify(motion, nullptr);
    tests += *culler.cull(sink).bvot;
  }
  return tests + kTestsOfPair * sink.count();
}

// Clusters of bones or of the surface, whichever make less work where bones turn.
std::vector<std::int32_t> clusters(const Setup& setup, DrvbcFastOptions::Clusters wanted, StageClock& clock) {
  using Clusters = DrvbcFastOptions::Clusters;
  if (!has_bones(setup) || wanted == Clusters::of_surface)
    return surface_clusters(setup.mesh, setup.reference);
  const std::vector<BoneId> bone_of = bones_of(setup, clock);
  std::vector<std::int32_t> of_bones = radial::make_atomic_clusters(setup.mesh, bone_of).of_triangle;
  if (wanted == Clusters::of_bones) return of_bones;
  std::vector<std::int32_t> of_surface = surface_clusters(setup.mesh, setup.reference);
  const std::vector<Trial> trials = trial_poses(setup.mesh, setup.reference, *setup.rig, bone_of, kTrials);
  return work(setup, of_surface, trials) < work(setup, of_bones, trials) ? of_surface : of_bones;
}

}  // namespace
}  // namespace fast

Prepared make_drvbc_fast(const Setup& setup, const DrvbcFastOptions& options) {
  require_closed_and_oriented(setup.mesh, "strategy " + std::string(options.name));
  StageClock clock;
  clock.enter(Stage::decomposition);
  std::vector<std::int32_t> cluster_of = fast::clusters(setup, options.clusters, clock);
  fast::Covers covers = fast::make_covers(setup.mesh, setup.reference, cluster_of);
  auto culler = std::make_unique<fast::FastCuller>(setup, std::move(covers), options);
  clock.stop();
  Preparation preparation;
  if (clock.milliseconds(Stage::distance_and_heat) > 0)
    preparation.distance_and_heat_ms = clock.milliseconds(Stage::distance_and_heat);
  preparation.decomposition_ms = clock.milliseconds(Stage::decomposition);
  preparation.atomic_clusters = 1 + *std::max_element(cluster_of.begin(), cluster_of.end());
  preparation.atomic_cluster = std::move(cluster_of);
  return {compose(std::move(culler), setup.mesh, setup.elementary), preparation};
}

}  // namespace cscd
