#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/detect/detector.h"
#include "core/detect/start/pose_crossings.h"

namespace cscd {

// What a strategy's contacts of one motion from a known pose say for sure. With a thickness, contacts are
// close pairs, and those that touch are among them.
struct Certainty {
  bool all = false;      // they are all contacts of the motion
  bool whether = false;  // if there are none, there is no contact, and start and end are clear
};

// Knows which triangle pairs cross in one pose: the last one that was searched, or to whose end a motion was
// followed. Two triangles begin or cease to cross only where something touches, so a step that starts in the
// known pose, and whose contacts are certain, tells what crosses at its end. Steps are therefore best asked
// for in the order of the motion. Where something touches, the start stays the known pose until a step starts
// at the end, because who looks for a step that is free asks about the same start again. Where nothing
// touches, the start stays known beside the end, if a start that was not known has been asked about lately.
//
// With a thickness it knows also which poses are *clear*: nothing crosses, and no pair is close. A step
// without a contact proves its start and its end clear. The pairs that touch are among the close ones, so
// crossings follow from close pairs too, of which those are left out that certainly stay apart.
class KnownStarts {
 public:
  // `use_bones` says whether detectors get the skeleton. The mesh, and what the thickness refers to, must
  // outlive the object.
  KnownStarts(const TriangleMesh& mesh, std::span<const Vec3> reference, bool use_bones,
              const Thickness& thickness = {});

  // What crosses in the known pose.
  const Crossings& crossings() const { return poses_.crossings(); }
  bool embedded() const { return crossings().total == 0; }
  // Whether the known pose is known to be clear. Without a thickness, an embedded pose is.
  bool clear() const { return embedded() && (thickness_.is_zero() || free_of_close_pairs_); }
  // How often crossings have been searched from nothing.
  std::size_t searches() const { return searches_; }

  // Begins a step. Where it starts in the known pose, or where the last step ended, takes its end for the
  // known pose already, and returns true; `finite` then says whether the positions of the end are. abandon()
  // or learn_end() have to follow.
  bool begin(const Motion& motion, bool& finite);
  // Ends a step of which nothing is learned: its start is the known pose again.
  void abandon(const Motion& motion);
  // Returns whether a pose, or the start of the step that has begun, is known.
  bool knows(std::span<const Vec3> pose) const { return moved_on_ || poses_.knows(pose); }

  // Searches a pose from nothing: by the detector, which has to see starts, or without one by a test of the
  // pose alone. `bones` holds the skeleton in the pose, at its start; null for a mesh without a rig.
  void search(std::span<const Vec3> pose, const Rig::Interval* bones, Detector* detector);
  // Has a detector that sees starts answer a step, and learns from it what crosses at the start.
  // learn_clear() says more.
  Report see(Detector& detector, Step step, ContactSet& found);
  // Asks the detector about the straight way from the known pose to `pose`, and learns from it what crosses
  // there. Returns false, and learns nothing, where that way proves nothing, or where something touches on
  // it: a way may be long, and then a search is cheaper than to find all that touches.
  bool follow_to(std::span<const Vec3> pose, const Rig::Interval* bones, Detector& detector,
                 const Certainty& certainty);
  // Learns whether the start of the step that has begun is free of close pairs.
  void learn_clear(bool free_of_close_pairs) { free_of_close_pairs_ = free_of_close_pairs; }
  // Learns what a step from the known pose proves about its end. `found` holds all its
  // contacts.
  void learn_end(const Motion& motion, const Rig::Interval* bones, const Certainty& certainty,
                 const ContactSet& found);

 private:
  const Rig::Interval* used(const Rig::Interval& bones) const { return use_bones_ ? &bones : nullptr; }

  PoseCrossings poses_;
  bool use_bones_;
  Thickness thickness_;
  bool free_of_close_pairs_ = false;  // known of the known pose
  std::size_t searches_ = 0;
  bool moved_on_ = false;           // poses_ holds the end of the step that has begun
  std::vector<Bone> pose_bones_;    // the skeleton in the known pose
  std::vector<Bone> before_bones_;  // and in the pose before it
  std::vector<Vec3> end_;           // of the last step in which something touched
  bool end_follows_ = false;        // whether the known pose and end_touched_ tell what crosses there
  ContactSet end_touched_;          // what touched on the way from the known pose
  std::vector<Bone> end_bones_;     // the skeleton there
  ContactSet touched_;              // on the way to a pose
  Crossings seen_;                  // at a start, by a detector
};

}  // namespace cscd
