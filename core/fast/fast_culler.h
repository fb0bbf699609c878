#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "core/base/thread_pool.h"
#include "core/detect/culler.h"
#include "core/detect/strategy.h"
#include "core/fast/adaptive_cover.h"
#include "core/fast/certify/certificates.h"
#include "core/fast/certify/one_rings.h"
#include "core/fast/classify/grid_bounds.h"
#include "core/fast/options.h"
#include "core/fast/patch_descent.h"
#include "core/fast/prepare/cut_surface.h"
#include "core/fast/prepare/saved_cut.h"

namespace cscd::fast {

// The culler behind all strategies that make_drvbc_fast (drvbc_fast.h) prepares. An interval takes one pass
// over all vertices (refit), one pass over all patches (classify), and a descent to the pairs of triangles
// that nothing proves apart (cull), all three on as many threads as the set-up asks for.
//
// In a long step, in which the surface moves far, hardly a triangle faces its observer throughout, and most
// boxes overlap. Such a step is looked at in parts: a pair of triangles that does not touch in any of them
// does not touch ("Theorem: an interval in parts" in core/soundness.md). Parts are halved as long as the
// surface moves far in them and their descents are long. All of that is part of cull.
class FastCuller : public Culler {
 public:
  // Takes over a surface that has been cut (prepare/cut_surface.h). The mesh of the set-up must outlive the
  // culler.
  FastCuller(const StrategyInput& setup, CutSurface cut, const DrvbcFastOptions& options);

  // Keeps the mesh of the set-up, where that is not the caller's, for as long as the culler lives.
  void keep(std::unique_ptr<const TriangleMesh> mesh) { kept_mesh_ = std::move(mesh); }

  // From the next interval on, the first cover follows the surface (adaptive_cover.h).
  void follow() { following_.emplace(mesh_, reference_, cut_); }
  // From the next interval on, looks from the first `count` covers alone, at least one.
  void use_covers(std::size_t count) {
    covers_used_ = count;
    certificates_.use_covers(count);
  }

  // Signs speak of one thickness for all pairs.
  bool knows_distance(const Thickness& thickness) const override {
    return options_.complete || thickness.is_uniform();
  }
  void refit(const Step& step) override;
  void refit_beginning(const Step& step, double until) override;
  // Looks at every patch from every cover, and makes the bounds of all nodes too, because a patch is loaded
  // once for its bounds and its orientations. Only a complete culler of a closed and consistently oriented
  // mesh makes use of an embedded start: signs alone certify until something touches, and capped clusters
  // only then. Returns true.
  bool classify(const Step& step) override;
  CullCounts cull(TrianglePairSink& sink) override;
  std::optional<std::uint64_t> cull_rest(TrianglePairSink& sink) override;
  bool keeps_all() const override { return uses_caps(); }
  void forget() override;
  // Returns nothing after an exception has broken off a change of clusters, until the next interval.
  std::vector<std::byte> saved_preparation() const override {
    if (following_ && !following_->whole()) return {};
    return saved_cut(mesh_, reference_, cut_, covers_used_);
  }
  const PatchTree* patches() const override { return &cut_.tree; }
  // Of a step in parts, the view is that of the last part.
  RadialView radial_view() const override { return certificates_.view(); }

  std::size_t patch_count() const { return cut_.tree.patches.size(); }
  // The number of looks (certify/certificates.h) that one interval takes.
  std::size_t orientation_passes() const { return certificates_.orientation_passes(); }

 private:
  // A part of the interval, from one time to another.
  struct TimeRange {
    double first = 0, last = 1;
  };
  static constexpr double kFinest = 64;  // parts are not halved further than that
  class Found : public TrianglePairSink {
   public:
    std::vector<TrianglePair> pairs;

   private:
    void take(const std::vector<TrianglePair>& block) override {
      pairs.insert(pairs.end(), block.begin(), block.end());
    }
  };

  struct Moved {
    float way, width;  // how far places of the surface move apart, and how wide patches are, in local units
    bool far() const { return way > width; }
  };
  Moved move_apart() const;
  bool can_tell_in_between(const Moved& moved) const;
  bool moves_far() const;
  bool uses_caps() const { return options_.complete && !by_signs_; }
  std::uint64_t descend(TrianglePairSink& sink);
  std::uint64_t descend_to_first(TrianglePairSink& sink);
  std::uint64_t run(TrianglePairSink& sink, std::uint64_t most = SharedDescent::kAnyNumber);
  void pass_on_near(TrianglePairSink& sink);
  Grid grid_of(float error) const { return Grid(error, local_thickness_ / 2); }
  std::optional<std::uint64_t> cut_short(TrianglePairSink& sink);
  std::uint64_t patience() const;
  std::uint64_t cull_parts(TrianglePairSink& sink);
  std::uint64_t cull_part();
  void move_to(const TimeRange& part);
  void classify_within(const TimeRange& part);
  void classify_all();
  void classify(std::size_t patch);
  void bound(std::size_t patch, const PatchLanes& lanes);
  void unite_bounds();
  void fetch(std::size_t patch) const;

  const TriangleMesh& mesh_;
  std::unique_ptr<const TriangleMesh> kept_mesh_;  // null where the caller keeps mesh_
  std::span<const Vec3> reference_;
  CutSurface cut_;
  std::size_t covers_used_ = 0;
  DrvbcFastOptions options_;
  bool signs_suffice_;     // from an embedded start, as long as nothing touches
  bool by_signs_ = false;  // of a complete culler
  LocalPositions positions_;
  Certificates certificates_;
  OneRings one_rings_;
  ThreadPool pool_;
  SharedDescent descent_;
  Grid grid_{1};
  std::vector<NodeBounds> bounds_;  // [nodes]
  std::optional<AdaptiveCover> following_;
  std::optional<std::uint64_t> tests_;  // that the last interval or part took; none before the first one
  std::optional<Motion> motion_;
  Thickness thickness_;
  float local_thickness_ = 0;  // the largest of any pair, in local units
  std::size_t near_ = 0;       // pairs near on the surface that the last pass by signs left
  TimeRange part_;             // that is looked at
  // Of long steps alone: the ends of a part, and what its descents have found.
  std::vector<Vec3> part_start_, part_end_;
  bool use_whole_step_ = false;  // whether the interval has to be looked at as a whole
  Found found_;
};

}  // namespace cscd::fast
