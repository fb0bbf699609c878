#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/base/vec3.h"
#include "core/detect/culler.h"
#include "core/detect/detector.h"
#include "core/detect/strategy.h"
#include "core/detect/thickness.h"
#include "core/mesh/motion.h"

namespace cscd {

// The pairs of triangles that are near each other in one pose, the *anchor*. While the surface stays near the
// anchor, all others are apart, so that a small step costs little more than a look at its positions
// (core/soundness.md, "Theorem: small steps near an anchor").
class NearPairs {
 public:
  // `reference`, [vertices], is any pose. The mesh and what the thickness refers to must outlive the object.
  NearPairs(const TriangleMesh& mesh, std::span<const Vec3> reference, const Thickness& thickness);

  // Takes note of what a strategy did in a step. A list may take a few times as long.
  void note_work(const CullCounts& counts);
  // Returns whether all pairs that come within their thickness during a step are in the list. Positions have
  // to be finite.
  bool covers(const Motion& motion);
  // Returns whether steps are so small that a list made at the start of this one is likely to cover several.
  bool is_worth_anchoring(const Motion& motion);
  // Makes the start of such a step the anchor, and lets a detector of a complete strategy find what is near
  // there. Returns whether the list covers the step.
  bool anchor(const Motion& motion, Detector& detector);
  // Adds to the sink the listed pairs that are not proven apart during the step that covers() or anchor()
  // accepted last. Most are told apart by what their own six vertices have moved against each other.
  void pass_on(const Motion& motion, TrianglePairSink& sink) const;
  // How many poses have been anchors.
  std::size_t anchors() const { return anchors_; }

 private:
  struct Near {
    double low;  // the two are at least so far apart in the anchor
    TrianglePair pair;
  };
  class Collector;

  // The largest distance, rounded up, of a vertex from its place in `from` at either end of the motion, less
  // one shift for each end. Infinite as soon as it exceeds `enough`.
  double moved(const Motion& motion, std::span<const Vec3> from, double enough) const;
  double sampled_length(const Motion& motion) const;
  bool is_within_reach(const Motion& motion);
  bool make_anchor(std::span<const Vec3> pose, double reach, Detector& detector);

  const TriangleMesh& mesh_;
  Thickness thickness_;
  double edge_;                      // the mean length of edges in the reference
  std::vector<std::size_t> sample_;  // vertices that stand for the surface
  std::vector<Vec3> anchor_;         // [vertices]; empty before the first
  double reach_ = 0;                 // pairs that are not listed are farther apart than this in the anchor
  std::vector<Near> near_;           // by distance
  double moved_ = 0;                 // from the anchor, in the last step that was covered
  double length_ = 0;                // of the last step that was worth anchoring
  double most_room_ = 0;             // how far beyond the thickness the next list may reach
  std::size_t worth_ = 0;   // how many pairs a list may hold, by the last step that a strategy answered
  std::size_t served_ = 0;  // steps that the anchor has covered
  // After an anchor that covered too few steps, so many steps go by before the next one, unless steps are far
  // shorter than those that the anchor did not last for.
  std::size_t waits_ = 0, next_wait_ = 0;
  double waits_for_ = 0;
  std::size_t anchors_ = 0;
};

// A detector that tests the pairs of a list which covers the step. What `setup` refers to and the list must
// outlive the detector.
std::unique_ptr<Detector> make_near_detector(const NearPairs& near, const StrategyInput& setup);

}  // namespace cscd
