#pragma once

#include <cstddef>
#include <functional>
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
#include "core/session/near_list.h"
#include "core/session/patch_motions.h"

namespace cscd {

// The pairs of triangles that are near each other, or cross, in one pose. While the surface stays near that
// pose, turned and shifted as a whole, all others are apart, so that a small step costs little more than a
// look at its positions (core/soundness.md, "Theorem: small steps near a pose").
//
// A complete strategy that sees starts finds the first list: it is asked about the pose at rest. That pose is
// the *anchor*. When the surface has moved on, the next list is made from the anchor by what patches have
// kept of their shape (PatchMotions). The strategy is asked again only where too many patches have bent.
//
// The object takes 24 bytes for each vertex and for each listed pair, and what PatchMotions takes. Lists hold
// at most twice as many pairs as there are triangles, or two thousand.
class NearPairs {
 public:
  // `reference`, [vertices], is the pose at rest. The mesh and what the thickness and the reference refer to
  // must outlive the object.
  NearPairs(const TriangleMesh& mesh, std::span<const Vec3> reference, const Thickness& thickness);

  // Takes note of what a strategy did in a step. No list is made before that is known.
  void note_work(const CullCounts& counts);
  // Returns the detector of a complete strategy that sees starts, or null where that is not to be asked yet.
  using Complete = std::function<Detector*()>;
  // Returns whether all pairs that come within their thickness during a step are in the list. Makes another
  // list where steps are so small that it is likely to pay. Positions have to be finite.
  bool covers(const Motion& motion, const Complete& complete);
  // Adds to the sink the listed pairs that are not proven apart during the step that is covered. Most are
  // told apart by what their own six vertices have moved against each other.
  void pass_on(const Motion& motion, TrianglePairSink& sink) const;
  // How many times a complete strategy was asked, and how many lists were made.
  std::size_t anchors() const { return anchors_; }
  std::size_t lists() const { return lists_; }

 private:
  bool is_within_reach(const Motion& motion);
  bool is_worth_listing(const Motion& motion);
  bool anchor(std::span<const Vec3> pose, Detector& detector);
  void forget_anchor();
  void use_list(double reach);
  bool list(std::span<const Vec3> pose, double room, const Complete& complete);
  void take_anchor(const Complete& complete);

  const TriangleMesh& mesh_;
  std::span<const Vec3> reference_;
  Thickness thickness_;
  double edge_;                      // the mean length of edges in the reference
  std::vector<std::size_t> sample_;  // vertices that stand for the surface
  std::optional<PatchMotions> motions_;

  std::vector<Vec3> pose_;      // [vertices]; empty before the first list
  double reach_ = 0;            // pairs that are not listed are farther apart than this in the pose
  std::vector<NearPair> near_;  // by distance
  bool is_anchor_ = false;      // the list is that of an anchor, from which no other list was made
  double needed_ = 0;           // the reach that the last step needs
  double length_ = 0;           // of the last step that was worth a list

  double most_room_;        // how far beyond the thickness the next anchor may reach
  double anchor_room_ = 0;  // how far beyond it the last one reaches
  std::size_t work_ = 0;    // of a strategy in the last step that it answered; 0 before the first
  // Steps that were covered, and lists that were made from it, since the last anchor.
  std::size_t served_ = 0, lists_of_anchor_ = 0;
  // Pairs that were looked at for the last anchor, and since then because patches have bent.
  std::size_t looked_at_ = 0, bent_ = 0;
  // After an anchor that served too few steps, so many steps go by before the next one, unless steps are far
  // shorter than those that the anchor did not last for.
  std::size_t waits_ = 0, next_wait_ = 0;
  double waits_for_ = 0;
  std::size_t anchors_ = 0, lists_ = 0;
};

// A detector that tests the pairs of a list which covers the step. What `setup` refers to and the list must
// outlive the detector.
std::unique_ptr<Detector> make_near_detector(const NearPairs& near, const StrategyInput& setup);

}  // namespace cscd
