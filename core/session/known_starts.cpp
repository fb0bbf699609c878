#include "core/session/known_starts.h"

#include <algorithm>
#include <iterator>
#include <optional>

#include "core/elementary/question/apart_before.h"
#include "core/geometry/feature_motion.h"

namespace cscd {
namespace {

// From more contacts than this it is quicker to look at the whole surface again.
constexpr std::size_t kMostFollowed = 20'000;

// Whether the features of a pair certainly do not touch.
bool stay_apart(const TriangleMesh& mesh, const Motion& motion, const FeaturePair& pair) {
  const auto ask = [](const auto& query) { return apart_before(query, 0, 1) >= 1; };
  return pair.kind == FeaturePair::Kind::vertex_face
             ? ask(vertex_face(mesh, motion, VertexId{pair.a}, TriangleId{pair.b}))
             : ask(edge_edge(mesh, motion, EdgeId{pair.a}, EdgeId{pair.b}));
}

}  // namespace

KnownStarts::KnownStarts(const TriangleMesh& mesh, std::span<const Vec3> reference, bool use_bones,
                         const Thickness& thickness)
    : poses_({mesh, reference}, kMostCrossings), use_bones_(use_bones), thickness_(thickness) {}

bool KnownStarts::begin(const Motion& motion, bool& finite) {
  moved_on_ = poses_.move_on(motion.start(), motion.end(), finite);
  if (!moved_on_ && poses_.return_to(motion.start())) {
    pose_bones_.swap(before_bones_);
    end_follows_ = false;
    moved_on_ = poses_.move_on(motion.start(), motion.end(), finite);
  }
  if (!moved_on_ && end_follows_ && same_bits(end_, motion.start())) {
    poses_.follow(end_, end_touched_);
    free_of_close_pairs_ = false;
    pose_bones_.swap(end_bones_);
    end_follows_ = false;
    end_.clear();
    moved_on_ = poses_.move_on(motion.start(), motion.end(), finite);
  }
  return moved_on_;
}

void KnownStarts::abandon(const Motion& motion) {
  if (moved_on_) poses_.go_back(motion.start());
  moved_on_ = false;
}

void KnownStarts::search(std::span<const Vec3> pose, const Rig::Interval* bones, Detector* detector) {
  if (detector != nullptr) {
    std::optional<Rig::Interval> rest;
    if (bones != nullptr) rest = Rig::Interval{bones->start, bones->start};
    see(*detector, {Motion(pose, pose), rest ? used(*rest) : nullptr}, touched_);
  } else {
    poses_.find(pose);
  }
  free_of_close_pairs_ = false;  // the search is about what crosses
  end_follows_ = false;
  ++searches_;
}

Report KnownStarts::see(Detector& detector, Step step, ContactSet& found) {
  step.crossings = &seen_;
  step.most_crossings = poses_.most();
  const Report report = detector.detect(step, found);
  poses_.know(step.motion.start(), seen_);
  end_follows_ = false;
  free_of_close_pairs_ = false;
  return report;
}

bool KnownStarts::follow_to(std::span<const Vec3> pose, const Rig::Interval* bones, Detector& detector,
                            const Certainty& certainty) {
  poses_.keep_before();  // whoever asks about another start may have asked about it before
  const bool has_bones = bones == nullptr || pose_bones_.size() == bones->start.size();
  if (!(certainty.all || certainty.whether) || !has_bones || same_bits(end_, pose)) return false;
  std::optional<Rig::Interval> way;
  if (bones != nullptr) way = Rig::Interval{pose_bones_, bones->start};
  detector.detect({.motion = Motion(poses_.positions(), pose),
                   .bones = way ? used(*way) : nullptr,
                   .starts_embedded = clear(),
                   .thickness = thickness_,
                   .any_contact = true},
                  touched_);
  if (!touched_.contacts.empty()) return false;
  end_follows_ = false;
  poses_.follow(pose, touched_);
  if (bones != nullptr) {
    before_bones_.swap(pose_bones_);
    pose_bones_.assign(bones->start.begin(), bones->start.end());
  }
  free_of_close_pairs_ = true;
  return true;
}

void KnownStarts::learn_end(const Motion& motion, const Rig::Interval* bones, const Certainty& certainty,
                            const ContactSet& found) {
  end_follows_ = false;  // until all that tells what crosses there is kept: memory may run out on the way
  if (bones != nullptr) pose_bones_.assign(bones->start.begin(), bones->start.end());
  const bool nothing_touched = found.contacts.empty() && certainty.whether;
  if (!nothing_touched) abandon(motion);
  if (nothing_touched) {
    if (!moved_on_) poses_.follow(motion.end(), found);
    free_of_close_pairs_ = true;
    end_.clear();
    before_bones_.swap(pose_bones_);
    if (bones != nullptr) pose_bones_.assign(bones->end.begin(), bones->end.end());
    return;
  }
  end_.assign(motion.end().begin(), motion.end().end());
  if (!certainty.all || found.contacts.size() > kMostFollowed) return;
  end_touched_.clear();
  std::ranges::copy_if(found.contacts, std::back_inserter(end_touched_.contacts), [&](const Contact& close) {
    return thickness_.is_zero() || !stay_apart(poses_.mesh(), motion, close.pair);
  });
  if (bones != nullptr) end_bones_.assign(bones->end.begin(), bones->end.end());
  end_follows_ = true;
}

}  // namespace cscd
