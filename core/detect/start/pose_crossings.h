#pragma once

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

#include "core/detect/contact.h"
#include "core/detect/start/crossings.h"
#include "core/detect/start/embedding.h"

namespace cscd {

// Keeps the crossing triangle pairs of a surface while it moves from one pose to the next.
//
// Finding them from nothing takes at least as long as a query. But two triangles begin or cease to cross only
// at a moment at which a feature pair that they carry touches (theorem "crossings follow from contacts" in
// core/soundness.md). So a caller who knows all feature pairs that touched on the way from a known pose has
// to look at their carriers alone. Where nothing touched, the same pairs cross as before: in particular, an
// embedded pose stays embedded.
class PoseCrossings {
 public:
  // `test` finds crossings from nothing. At most `most` pairs are kept for a pose.
  PoseCrossings(EmbeddingTest test, std::size_t most) : test_(std::move(test)), most_(most) {}

  // Returns whether `positions` are those last asked for, bit for bit, so that
  // their crossings are known already.
  bool knows(std::span<const Vec3> positions) const;

  // Moves on to the end of a step before it is known what touches on the way: where `start` are the positions
  // last asked for, bit for bit, puts `end` in their place, and returns true. Otherwise changes nothing and
  // returns false. `finite` says whether the positions are, of `end` where this returns true. One pass
  // compares, copies and looks for what is not finite, which takes a third of the time of three passes. The
  // crossings stay those of `start`. They are right of `end` too if nothing touches; if something does, the
  // caller has to go back.
  bool move_on(std::span<const Vec3> start, std::span<const Vec3> end, bool& finite);
  // Puts the start of the step in the place of its end again.
  void go_back(std::span<const Vec3> start);
  // Where nothing touched on the way here, the same pairs cross in the pose before. Returns whether
  // `positions` are that pose, bit for bit, and if so takes it for the one last asked for, and this one for
  // the pose before. So a caller may ask about several steps from one start. The pose before is kept for some
  // steps after keep_before(), and after each return. A clip that only goes on has no use for it, and a short
  // step would take longer.
  bool return_to(std::span<const Vec3> positions);

  // Lets the next steps keep the pose before.
  void keep_before() { kept_steps_ = kKeptSteps; }

  // The positions last asked for, and the crossings in them.
  std::span<const Vec3> positions() const { return positions_; }
  const Crossings& crossings() const { return crossings_; }

  // Finds the crossings in `positions` from nothing.
  const Crossings& find(std::span<const Vec3> positions);

  // Takes what a caller knows to be the crossings in `positions`.
  void know(std::span<const Vec3> positions, const Crossings& crossings);

  const TriangleMesh& mesh() const { return test_.mesh(); }
  // The number of crossing pairs that are kept for a pose.
  std::size_t most() const { return most_; }

  // Derives the crossings in `positions` from the pose last asked for. Every vertex must have moved from
  // there in a straight line, and `touched` must hold all feature pairs that touched on the way, contacts and
  // undecided ones. If no pose was asked for yet, or the last pose has more crossing pairs than were kept,
  // this finds the crossings from nothing.
  const Crossings& follow(std::span<const Vec3> positions, const ContactSet& touched);

 private:
  static constexpr int kKeptSteps = 32;

  // Makes the pose in room_ the one last asked for, and that one the pose before.
  void take_room();

  EmbeddingTest test_;
  std::size_t most_;
  std::vector<Vec3> positions_;
  std::vector<Vec3> before_;  // the pose before, in which the same pairs cross; empty where there is none
  std::vector<Vec3> room_;    // for the next pose
  int kept_steps_ = 0;
  Crossings crossings_;
};

}  // namespace cscd
