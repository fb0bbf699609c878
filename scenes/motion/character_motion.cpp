#include "scenes/motion/character_motion.h"

#include <algorithm>
#include <limits>

#include "core/base/error.h"
#include "core/base/sort_unique.h"
#include "scenes/character/pose.h"

namespace cscd::scenes {
namespace {

// Of the size of a time, what some roundings of it come to; and seconds, more than that by far.
constexpr double kRounded = 8 * 0x1p-52, kApart = 1e-9;

const Animation& clip_of(const Character& character) {
  if (character.animations.size() != 1) throw InputError("motion: is not about one clip");
  return character.animations.front();
}

}  // namespace

CharacterMotion::CharacterMotion(MovingCharacter moving)
    : moving_(std::move(moving)), pose_(moving_.character, clip_of(moving_.character)) {
  if (const std::string refused = pose_.refused(); !refused.empty())
    throw NoBounds("no bounds are known for " + refused + "; ask about straight lines, without it");
  for (const Part& part : moving_.character.parts)
    points_.push_back(points_in_joints(part)), linear_.emplace_back(part);
  const std::vector<double>& jumps = pose_.jumps();
  for (const double corner : pose_.corners()) {
    const auto jump = std::lower_bound(jumps.begin(), jumps.end(), corner - kApart);
    if (jump == jumps.end() || *jump > corner + kApart) corners_.push_back(corner);
  }
  std::vector<Place> all;
  for (std::size_t p = 0; p < moving_.character.parts.size(); ++p)
    for (std::size_t v = 0; v < moving_.character.parts[p].positions.size(); ++v)
      all.push_back({static_cast<std::int32_t>(p), static_cast<std::int32_t>(v)});
  for (const std::int32_t raw : moving_.raw_vertex) place_.push_back(all.at(static_cast<std::size_t>(raw)));
}

// Keys have times on the file's time line. The sum rounds as the import's does; what rounding moves off a
// corner is put back there, because a corner just inside a span costs it its bounds on rates.
double CharacterMotion::on_time_line(double seconds) const {
  const double start = moving_.character.animations.front().start, time = start + seconds;
  return corner_near(time, kRounded * (std::abs(start) + std::abs(time))).value_or(time);
}

std::optional<double> CharacterMotion::corner_near(double time, double reach) const {
  const auto next = std::lower_bound(corners_.begin(), corners_.end(), time);
  std::optional<double> best;
  for (auto c = next == corners_.begin() ? next : next - 1; c != corners_.end() && c <= next; ++c)
    if (std::abs(*c - time) <= reach && (!best || std::abs(*c - time) < std::abs(*best - time))) best = *c;
  return best;
}

double CharacterMotion::at_corner(double seconds, double reach) const {
  const double start = moving_.character.animations.front().start;
  const std::optional<double> corner = corner_near(start + seconds, reach);
  return corner ? *corner - start : seconds;
}

bool CharacterMotion::is_linear(std::size_t part, const PoseJets::Weights& weights) const {
  const std::vector<double>& dual = moving_.character.parts[part].dual_quaternion;
  return std::ranges::all_of(weights.of_part[part],
                             [](const Jet& w) { return w.is_still() && w.value.is_zero(); }) &&
         std::ranges::all_of(dual, [](double share) { return share == 0; });
}

// Where an enclosure breaks down, as at the moment at which two bones under dual quaternions are half a turn
// apart, vertices are where a frame would show them, which may be anywhere near.
void CharacterMotion::positions(double seconds, std::span<const VertexId> vertices, std::span<Vec3> at,
                                std::span<double> error) const {
  try {
    enclose(seconds, vertices, at, error);
  } catch (const Unbounded&) {
    const Character& character = moving_.character;
    const double time = on_time_line(seconds);
    std::vector<Vec3> all;
    skin(character, pose_at(character, clip_of(character), time),
         weights_at(character, clip_of(character), time), all);
    for (std::size_t i = 0; i < vertices.size(); ++i)
      at[i] = all[static_cast<std::size_t>(moving_.raw_vertex[+vertices[i]])];
    std::ranges::fill(error, std::numeric_limits<double>::infinity());
  }
}

void CharacterMotion::enclose(double seconds, std::span<const VertexId> vertices, std::span<Vec3> at,
                              std::span<double> error) const {
  const Span moment = on_time_line(seconds, seconds);
  const PoseJets::Weights weights = pose_.weights(moment);
  const PoseJets::Nodes nodes = pose_.nodes(moment);
  const std::vector<Part>& parts = moving_.character.parts;
  std::vector<std::optional<SkinJets>> skins(parts.size());
  std::vector<std::vector<LinearSkin::JointPlace>> joint_places(parts.size());
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const auto part = static_cast<std::size_t>(place_[+vertices[i]].part);
    const auto v = static_cast<std::size_t>(place_[+vertices[i]].vertex);
    if (joint_places[part].empty() && !skins[part]) {
      if (is_linear(part, weights))
        joint_places[part] = linear_[part].joint_places(nodes.over);
      else
        skins[part].emplace(parts[part], points_[part], nodes, weights.of_part[part]);
    }
    if (skins[part]) {
      const BallVector place = skins[part]->vertex(v).value;
      at[i] = place.centre;
      error[i] = place.radius;
    } else {
      error[i] = linear_[part].place(v, joint_places[part], at[i]);
    }
  }
}

// What joints do over a span, from what they do in pieces of it: between corners, and in halves where bends
// are more uncertain than large, because what is uncertain falls faster than the halves' number grows.
class CharacterMotion::LinearPaths {
 public:
  LinearPaths(const CharacterMotion& motion, std::vector<std::size_t> parts)
      : motion_(motion), parts_(std::move(parts)), last_(parts_.size()), bends_(parts_.size()) {}

  JointBounds deviations(const Span& span) {
    const double h = rounded_up(span.to - span.from);
    JointBounds corners(parts_.size());
    double from = span.from;
    for (auto corner = std::upper_bound(motion_.pose_.corners().begin(), motion_.pose_.corners().end(), from);
         corner != motion_.pose_.corners().end() && *corner < span.to; ++corner) {
      add({from, *corner}, 0, corners);
      from = *corner;
      corner_ = rounded_up((from - span.from) * (span.to - from) / h);
    }
    add({from, span.to}, 0, corners);
    for (std::size_t p = 0; p < parts_.size(); ++p)
      for (std::size_t j = 0; j < bends_[p].size(); ++j) add_product(bends_[p][j], h * h / 8, corners[p][j]);
    return corners;
  }

 private:
  static void add_product(const LinearSkin::AffineBound& x, double factor, LinearSkin::AffineBound& to) {
    to.at_centre = grown(to.at_centre + x.at_centre * factor);
    to.per_distance = grown(to.per_distance + x.per_distance * factor);
  }

  void add(const Span& span, int halvings, JointBounds& corners) {
    const PoseJets::Nodes nodes = motion_.pose_.nodes(span);
    std::vector<LinearSkin::JointMotions> motions;
    double bend = 0, uncertainty = 0;
    for (const std::size_t part : parts_) {
      motions.push_back(motion_.linear_[part].motions(nodes.over));
      bend = std::max(bend, motions.back().bend),
      uncertainty = std::max(uncertainty, motions.back().uncertainty);
    }
    const double middle = span.from + (span.to - span.from) / 2;
    if (uncertainty > kMostUncertainty * bend && halvings < kMostHalvings && span.from < middle &&
        middle < span.to) {
      add({span.from, middle}, halvings + 1, corners);
      add({middle, span.to}, halvings + 1, corners);
      return;
    }
    for (std::size_t p = 0; p < parts_.size(); ++p) {
      const std::size_t joints = motions[p].joints.size();
      bends_[p].resize(joints), corners[p].resize(joints);
      for (std::size_t j = 0; j < joints; ++j) {
        LinearSkin::AffineBound& most = bends_[p][j];
        const LinearSkin::AffineBound& own = motions[p].joints[j].bend;
        most = {std::max(most.at_centre, own.at_centre), std::max(most.per_distance, own.per_distance)};
      }
      if (corner_ > 0) {
        const std::vector<LinearSkin::AffineBound> changes =
            motion_.linear_[parts_[p]].rate_changes(last_[p], motions[p]);
        for (std::size_t j = 0; j < joints; ++j) add_product(changes[j], corner_, corners[p][j]);
      }
    }
    corner_ = 0;
    last_ = std::move(motions);
  }

  static constexpr double kMostUncertainty = 0.5;
  static constexpr int kMostHalvings = 4;

  const CharacterMotion& motion_;
  std::vector<std::size_t> parts_;
  std::vector<LinearSkin::JointMotions> last_;  // [parts], over the last piece
  JointBounds bends_;                           // the largest over all pieces
  double corner_ = 0;  // what a change of the rate between the last piece and the next one is worth
};

const CharacterMotion::JointBounds& CharacterMotion::joint_bounds(
    const Span& span, const std::vector<std::size_t>& parts) const {
  if (last_.from != span.from || last_.to != span.to || last_.parts != parts)
    last_ = {span.from, span.to, parts, LinearPaths(*this, parts).deviations(span)};
  return last_.bounds;
}

void CharacterMotion::deviations(double from, double to, std::span<const VertexId> vertices,
                                 std::span<double> out) const {
  const Span span = on_time_line(from, to);
  std::ranges::fill(out, std::numeric_limits<double>::infinity());
  if (next_jump(from, to)) return;
  const double h = rounded_up(span.to - span.from);
  // A corner at time c moves the path off the line by (c - from) (to - c) / h times the change of its rate.
  double corners = 0;
  for (auto c = std::upper_bound(pose_.corners().begin(), pose_.corners().end(), span.from);
       c != pose_.corners().end() && *c < span.to; ++c)
    corners += rounded_up((*c - span.from) * (span.to - *c) / h);
  const std::vector<Part>& parts = moving_.character.parts;
  std::vector<std::vector<std::size_t>> of_part(parts.size());  // those of the vertices
  for (std::size_t i = 0; i < vertices.size(); ++i)
    of_part[static_cast<std::size_t>(place_[+vertices[i]].part)].push_back(i);
  try {
    const PoseJets::Weights weights = pose_.weights(span);
    std::vector<std::size_t> linear, others;
    for (std::size_t p = 0; p < parts.size(); ++p)
      if (!of_part[p].empty()) (is_linear(p, weights) ? linear : others).push_back(p);
    const auto vertex = [&](std::size_t i) { return static_cast<std::size_t>(place_[+vertices[i]].vertex); };
    if (!linear.empty()) {
      const JointBounds& of_joints = joint_bounds(span, linear);
      for (std::size_t p = 0; p < linear.size(); ++p)
        for (const std::size_t i : of_part[linear[p]])
          if (const double bound = linear_[linear[p]].deviation(vertex(i), of_joints[p]);
              bound < std::numeric_limits<double>::infinity())
            out[i] = bound;
    }
    if (others.empty()) return;
    const PoseJets::Nodes nodes = pose_.nodes(span);
    for (const std::size_t p : others) {
      const SkinJets skin(parts[p], points_[p], nodes, weights.of_part[p]);
      for (const std::size_t i : of_part[p]) try {
          const MovingVector x = skin.vertex(vertex(i));
          const double change = 2 * x.rate.radius, bend = norm_above(x.bend.centre) + x.bend.radius;
          double bound = change * h / 4;
          if (!weights.corners_anywhere) bound = std::min(bound, bend * h * h / 8 + change * corners);
          if (bound < std::numeric_limits<double>::infinity()) out[i] = grown(bound);
        } catch (const Unbounded&) {
          // stays without a bound
        }
    }
  } catch (const Unbounded&) {
    std::ranges::fill(out, std::numeric_limits<double>::infinity());
  }
}

double CharacterMotion::largest_deviation(double from, double to) const {
  const Span span = on_time_line(from, to);
  constexpr double kNone = std::numeric_limits<double>::infinity();
  if (next_jump(from, to)) return kNone;
  try {
    const PoseJets::Weights weights = pose_.weights(span);
    std::vector<std::size_t> moved;
    for (const Place& place : place_)
      if (const auto part = static_cast<std::size_t>(place.part); moved.empty() || moved.back() != part)
        moved.push_back(part);
    sort_unique(moved);
    for (const std::size_t part : moved)
      if (!is_linear(part, weights)) return VertexPaths::largest_deviation(from, to);
    const JointBounds& of_joints = joint_bounds(span, moved);
    double largest = 0;
    for (std::size_t p = 0; p < moved.size(); ++p)
      largest = std::max(largest, linear_[moved[p]].largest_deviation(of_joints[p]));
    return largest < kNone ? largest : kNone;
  } catch (const Unbounded&) {
    return kNone;
  }
}

double CharacterMotion::split(double from, double to) const {
  const Span span = on_time_line(from, to);
  const double h = span.to - span.from;
  double best = from + (to - from) / 2, most = 0;
  for (auto c = std::upper_bound(pose_.corners().begin(), pose_.corners().end(), span.from);
       c != pose_.corners().end() && *c < span.to; ++c) {
    const double off = (*c - span.from) * (span.to - *c) / h;
    const double seconds = *c - moving_.character.animations.front().start;
    if (off <= most || seconds <= from || seconds >= to) continue;
    most = off;
    best = seconds;
  }
  return best;
}

std::optional<VertexPaths::Jump> CharacterMotion::next_jump(double from, double to) const {
  const Span span = on_time_line(from, to);
  const auto jump = std::upper_bound(pose_.jumps().begin(), pose_.jumps().end(), span.from);
  if (jump == pose_.jumps().end() || *jump > span.to) return std::nullopt;
  // The neighbouring times on either side, as seconds after the start of the clip.
  const double start = moving_.character.animations.front().start;
  const double seconds = *jump - start, step = 0x1p-52 * (std::abs(start) + std::abs(*jump) + 1e-9);
  Jump out{seconds, seconds};
  while (!(start + out.before < *jump)) out.before -= step;
  while (!(start + out.after >= *jump)) out.after += step;
  return out;
}

}  // namespace cscd::scenes
