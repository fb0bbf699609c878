#include "core/engine/drvbc_fast.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <numbers>

#include "core/base/stage_clock.h"
#include "core/detect/compose.h"
#include "core/engine/patch_lanes.h"
#include "core/engine/stars.h"
#include "core/mesh/adjacency.h"
#include "core/radial/distance_field.h"
#include "core/radial/observer.h"
#include "core/radial/refinement.h"
#include "core/radial/segmentation.h"
#include "core/radial/setup.h"

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
        stars_(setup.mesh),
        lanes_(tree_.patches.size()),
        bounds_(tree_.nodes.size()),
        label_(tree_.nodes.size()),
        certified_(tree_.patches.size()),
        negative_(tree_.patches.size()),
        triangle_bounds_of_(tree_.patches.size(), kNone) {
    for (std::size_t c = 0; c < kCovers; ++c) viewpoint_[c].resize(covers_[c].observers.size());
  }

  void refit(const Motion& motion) override {
    positions_.update(motion);
    std::size_t patch = tree_.patches.size();
    for (std::size_t n = tree_.nodes.size(); n-- > 0;) {
      const PatchTree::Node& node = tree_.nodes[n];
      if (node.is_leaf()) {
        --patch;
        lanes_[patch] = load(positions_.records(), tree_.patches[patch]);
        bounds_[n] = bounds_of(lanes_[patch], positions_.error());
        if (!options_.time_linear)
          bounds_[n].at[0] = bounds_[n].at[1] = smaller(bounds_[n].at[0], bounds_[n].at[1]);
      } else {
        bounds_[n] = united(bounds_[n + 1], bounds_[static_cast<std::size_t>(node.right)]);
      }
    }
    if (!positions_.known()) overlap_everything();
  }

  bool classify(const Motion&, const Rig::Interval*) override {
    place_viewpoints();
    counts_ = {};
    const std::size_t covers = options_.second_cover ? kCovers : 1;
    for (std::size_t c = 0; c < covers; ++c) counts_.clusters += viewpoint_[c].size();
    for (std::size_t p = 0; p < tree_.patches.size(); ++p) {
      const Patch& patch = tree_.patches[p];
      for (std::size_t c = 0; c < kCovers; ++c)
        certified_[p][c] = {c < covers ? patch.inside[c] : Mask16{0}, Mask16{0}};
    }
    for (std::size_t p = 0; p < tree_.patches.size(); ++p) {
      const Patch& patch = tree_.patches[p];
      const PatchNormals normals = normals_of(lanes_[p], patch);
      for (std::size_t c = 0; c < covers; ++c) {
        if (patch.cluster[c] == kNone) continue;
        const Viewpoint& from = viewpoint_[c][static_cast<std::size_t>(patch.cluster[c])];
        const Signs signs = orientation(normals, from, positions_.error());
        negative_[p][c] = signs.negative & patch.lanes;
        for (unsigned rest = patch.lanes & ~signs.positive; rest != 0; rest &= rest - 1)
          for (const Lane& near :
               tree_.ring_of(patch.triangle[static_cast<std::size_t>(std::countr_zero(rest))]))
            certified_[static_cast<std::size_t>(near.patch)][c].positive &=
                static_cast<Mask16>(~(1U << near.lane));
      }
    }
    for (std::size_t p = 0; p < tree_.patches.size(); ++p)
      for (std::size_t c = 0; c < covers; ++c) {
        const Patch& patch = tree_.patches[p];
        for (unsigned rest = negative_[p][c] & patch.inside[c]; rest != 0; rest &= rest - 1) {
          const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
          const std::span<const Lane> ring = tree_.ring_of(patch.triangle[lane]);
          const bool all = std::all_of(ring.begin(), ring.end(), [&](const Lane& near) {
            return negative_[static_cast<std::size_t>(near.patch)][c] >> near.lane & 1;
          });
          certified_[p][c].negative |= static_cast<Mask16>(all << lane);
        }
      }
    if (!positions_.known())
      for (auto& masks : certified_) masks = {};
    std::size_t p = tree_.patches.size();
    for (std::size_t n = tree_.nodes.size(); n-- > 0;) {
      const PatchTree::Node& node = tree_.nodes[n];
      if (node.is_leaf()) {
        --p;
        const Patch& patch = tree_.patches[p];
        Mask16 some = 0;
        for (std::size_t c = 0; c < kCovers; ++c) {
          const Signs& signs = certified_[p][c];
          label_[n][c] = signs.positive == patch.lanes   ? 2 * patch.cluster[c]
                         : signs.negative == patch.lanes ? 2 * patch.cluster[c] + 1
                                                         : kNone;
          some |= signs.positive | signs.negative;
        }
        counts_.positive += static_cast<unsigned>(std::popcount(certified_[p][0].positive));
        counts_.negative += static_cast<unsigned>(std::popcount(certified_[p][0].negative));
        counts_.uncertain += static_cast<unsigned>(std::popcount(static_cast<Mask16>(patch.lanes & ~some)));
      } else {
        const auto &left = label_[n + 1], &right = label_[static_cast<std::size_t>(node.right)];
        for (std::size_t c = 0; c < kCovers; ++c) label_[n][c] = left[c] == right[c] ? left[c] : kNone;
      }
    }
    return true;
  }

  CullCounts cull(TrianglePairSink& sink) override {
    sink_ = &sink;
    tests_ = 0;
    used_ = 0;
    stars_.start_interval(positions_);
    std::fill(triangle_bounds_of_.begin(), triangle_bounds_of_.end(), kNone);
    self(0);
    CullCounts counts;
    counts.bvot = tests_;
    counts.radial = counts_;
    return counts;
  }

  std::vector<std::int32_t> clusters() const override { return covers_[0].cluster_of; }

 private:
  static bool same(const std::array<std::int32_t, kCovers>& a, const std::array<std::int32_t, kCovers>& b) {
    bool one = false;
    for (std::size_t c = 0; c < kCovers; ++c) one |= a[c] == b[c] && a[c] != kNone;
    return one;
  }

  void overlap_everything() {
    for (MovingBounds& b : bounds_)
      for (Float16& end : b.at) end = Float16{} - std::numeric_limits<float>::infinity();
  }

  void place_viewpoints() {
    for (std::size_t c = 0; c < kCovers; ++c)
      for (std::size_t i = 0; i < viewpoint_[c].size(); ++i) {
        const FollowingPoint& from = covers_[c].observers[i];
        float sum[8] = {};
        for (std::size_t v = 0; v < from.vertices.size(); ++v)
          for (std::size_t k = 0; k < 8; ++k)
            sum[k] += from.weights[v] * positions_.records()[+from.vertices[v]].at[k];
        for (std::size_t end = 0; end < 2; ++end)
          for (std::size_t k = 0; k < 3; ++k) viewpoint_[c][i].at[end][k] = sum[4 * end + k];
      }
  }

  void self(std::size_t n) {
    if (same(label_[n], label_[n])) return;
    const PatchTree::Node& node = tree_.nodes[n];
    if (node.is_leaf()) return inside(n);
    const auto right = static_cast<std::size_t>(node.right);
    self(n + 1);
    self(right);
    pair(n + 1, right);
  }

  void pair(std::size_t a, std::size_t b) {
    if (same(label_[a], label_[b])) return;
    ++tests_;
    if (apart(bounds_[a], bounds_[b])) return;
    const PatchTree::Node &first = tree_.nodes[a], &second = tree_.nodes[b];
    if (first.is_leaf() && second.is_leaf()) return between(a, b);
    if (first.is_leaf()) {
      pair(a, b + 1);
      pair(a, static_cast<std::size_t>(second.right));
    } else if (second.is_leaf()) {
      pair(a + 1, b);
      pair(static_cast<std::size_t>(first.right), b);
    } else {
      const auto ra = static_cast<std::size_t>(first.right), rb = static_cast<std::size_t>(second.right);
      pair(a + 1, b + 1);
      pair(a + 1, rb);
      pair(ra, b + 1);
      pair(ra, rb);
    }
  }

  // Triangles of patch q that triangle `lane` of patch p has to be held against.
  Mask16 needed(std::size_t p, std::size_t lane, std::size_t q) const {
    unsigned dropped = 0;
    for (std::size_t c = 0; c < kCovers; ++c)
      if (tree_.patches[p].cluster[c] == tree_.patches[q].cluster[c]) {
        if (certified_[p][c].positive >> lane & 1) dropped |= certified_[q][c].positive;
        if (certified_[p][c].negative >> lane & 1) dropped |= certified_[q][c].negative;
      }
    return static_cast<Mask16>(tree_.patches[q].lanes & ~dropped);
  }

  const TriangleBounds& bounds_of_triangles(std::size_t p) {
    if (triangle_bounds_of_[p] == kNone) {
      if (used_ == pool_.size()) pool_.emplace_back();
      triangle_bounds_of_[p] = static_cast<std::int32_t>(used_);
      TriangleBounds& b = pool_[used_++];
      b = triangle_bounds(lanes_[p], tree_.patches[p], positions_.error());
      if (!options_.time_linear)
        for (std::size_t k = 0; k < kDirections; ++k) {
          b.low[k][0] = b.low[k][1] = smaller(b.low[k][0], b.low[k][1]);
          b.high[k][0] = b.high[k][1] = larger(b.high[k][0], b.high[k][1]);
        }
    }
    return pool_[static_cast<std::size_t>(triangle_bounds_of_[p])];
  }

  void emit(std::size_t p, std::size_t lane, std::size_t q, Mask16 lanes) {
    for (unsigned rest = lanes; rest != 0; rest &= rest - 1)
      sink_->add(tree_.patches[p].triangle[lane],
                 tree_.patches[q].triangle[static_cast<std::size_t>(std::countr_zero(rest))]);
  }

  bool in_flat_star(TriangleId t, TriangleId u) {
    const Triangle &a = mesh_.corners(t), &b = mesh_.corners(u);
    return std::any_of(a.begin(), a.end(), [&](VertexId v) { return contains(b, v) && stars_.flat(v); });
  }

  // Takes the lanes of patch q that are adjacent to a triangle of patch p out of `wanted`: passed on without
  // a test of bounds, which always overlap, unless a flat star holds both.
  Mask16 without_adjacent(std::size_t p, std::size_t lane, std::size_t q, Mask16 wanted) {
    const TriangleId t = tree_.patches[p].triangle[lane];
    unsigned adjacent = 0;
    for (const Lane& near : tree_.ring_of(t))
      if (static_cast<std::size_t>(near.patch) == q) adjacent |= 1U << near.lane;
    adjacent &= wanted;
    for (unsigned rest = adjacent; rest != 0; rest &= rest - 1) {
      const TriangleId u = tree_.patches[q].triangle[static_cast<std::size_t>(std::countr_zero(rest))];
      if (!options_.stars || !in_flat_star(t, u)) sink_->add(t, u);
    }
    return static_cast<Mask16>(wanted & ~adjacent);
  }

  void inside(std::size_t n) {
    const std::size_t p = tree_.nodes[n].patch();
    const TriangleBounds* bounds = nullptr;
    for (std::size_t lane = 0; lane + 1 < kLanes16; ++lane) {
      auto later = static_cast<Mask16>(needed(p, lane, p) & ~((2U << lane) - 1));
      if (!(tree_.patches[p].lanes >> lane & 1) || later == 0) continue;
      later = without_adjacent(p, lane, p, later);
      if (later == 0) continue;
      if (bounds == nullptr) bounds = &bounds_of_triangles(p);
      tests_ += static_cast<unsigned>(std::popcount(later));
      emit(p, lane, p, positions_.known() ? near(*bounds, later, *bounds, lane) : later);
    }
  }

  void between(std::size_t a, std::size_t b) {
    const std::size_t p = tree_.nodes[a].patch(), q = tree_.nodes[b].patch();
    if (!positions_.known()) {
      for (std::size_t lane = 0; lane < kLanes16; ++lane)
        if (tree_.patches[p].lanes >> lane & 1) emit(p, lane, q, tree_.patches[q].lanes);
      return;
    }
    Mask16 rows = 0, columns = 0, need[kLanes16];
    for (std::size_t lane = 0; lane < kLanes16; ++lane) {
      need[lane] = tree_.patches[p].lanes >> lane & 1 ? needed(p, lane, q) : Mask16{0};
      if (need[lane] != 0) rows |= static_cast<Mask16>(1U << lane);
      columns |= need[lane];
    }
    if (rows == 0) return;
    bounds_of_triangles(p), bounds_of_triangles(q);  // before references to the pool are taken
    const TriangleBounds &first = bounds_of_triangles(p), &second = bounds_of_triangles(q);
    tests_ += static_cast<unsigned>(std::popcount(rows));
    rows = near(first, rows, bounds_[b]);
    if (rows == 0) return;
    tests_ += static_cast<unsigned>(std::popcount(columns));
    columns = near(second, columns, bounds_[a]);
    for (unsigned rest = rows; rest != 0 && columns != 0; rest &= rest - 1) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
      auto wanted = static_cast<Mask16>(need[lane] & columns);
      if (wanted == 0) continue;
      wanted = without_adjacent(p, lane, q, wanted);
      if (wanted == 0) continue;
      tests_ += static_cast<unsigned>(std::popcount(wanted));
      emit(p, lane, q, near(second, wanted, first, lane));
    }
  }

  const TriangleMesh& mesh_;
  Covers covers_;
  DrvbcFastOptions options_;
  LocalPositions positions_;
  PatchTree tree_;
  Stars stars_;
  std::vector<PatchLanes> lanes_;
  std::vector<MovingBounds> bounds_;  // of each node
  std::vector<std::array<std::int32_t, kCovers>>
      label_;                                          // of each node: the cluster that certifies all below
  std::vector<std::array<Signs, kCovers>> certified_;  // of each patch
  std::vector<std::array<Mask16, kCovers>> negative_;  // of each patch
  std::array<std::vector<Viewpoint>, kCovers> viewpoint_;
  std::vector<std::int32_t> triangle_bounds_of_;  // where in the pool
  std::vector<TriangleBounds> pool_;
  std::size_t used_ = 0;
  RadialCounts counts_;
  TrianglePairSink* sink_ = nullptr;
  std::uint64_t tests_ = 0;
};

}  // namespace
}  // namespace fast

Prepared make_drvbc_fast(const Setup& setup, const DrvbcFastOptions& options) {
  radial::require_radial_setup(setup, std::string(options.name));
  const double theta = 10 * std::numbers::pi / 180;
  StageClock clock;
  clock.enter(Stage::distance_and_heat);
  const int full = radial::resolution_of_mean_edge(setup.mesh, setup.reference);
  std::vector<BoneId> bone_of =
      radial::nearest_bone_by_heat(setup.mesh, setup.reference, *setup.rig, {std::max(1, full / 4), 5});
  clock.enter(Stage::decomposition);
  radial::AtomicClusters clusters = radial::make_atomic_clusters(setup.mesh, bone_of);
  const std::vector<radial::ObserverKind> kinds =
      radial::choose_by_rotation_trial(setup.mesh, setup.reference, *setup.rig, clusters, theta);
  bone_of = radial::refine_by_orientation(setup.mesh, setup.reference, *setup.rig, clusters, kinds);
  clusters = radial::make_atomic_clusters(setup.mesh, bone_of);
  fast::Covers covers = fast::make_covers(setup.mesh, setup.reference, clusters);
  clock.stop();
  Preparation preparation{clock.milliseconds(Stage::distance_and_heat),
                          clock.milliseconds(Stage::decomposition), clusters.of_triangle,
                          static_cast<int>(clusters.clusters.size())};
  auto culler = std::make_unique<fast::FastCuller>(setup, std::move(covers), options);
  return {compose(std::move(culler), setup.mesh, setup.elementary), preparation};
}

}  // namespace cscd
