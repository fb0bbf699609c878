#include "scenes/motion/linear_skin.h"

#include <algorithm>

#include "scenes/motion/pose_jets.h"
#include "scenes/motion/skin_jets.h"

namespace cscd::scenes {

LinearSkin::LinearSkin(const Part& part) {
  for (const Joint& joint : part.joints) clouds_.push_back({static_cast<std::size_t>(joint.node)});
  clouds_.push_back({static_cast<std::size_t>(part.node)});
  const std::vector<BallVector> points = points_in_joints(part);
  std::vector<Vec3> low(clouds_.size()), high(clouds_.size());
  const auto add = [&](std::size_t joint, double weight, const BallVector& point) {
    Cloud& cloud = clouds_[joint];
    low[joint] = cloud.used ? Vec3(low[joint].cwiseMin(point.centre)) : point.centre;
    high[joint] = cloud.used ? Vec3(high[joint].cwiseMax(point.centre)) : point.centre;
    cloud.used = true;
    cloud.error = std::max(cloud.error, point.radius);
    cloud.length = std::max(cloud.length, grown(norm_above(point.centre) + point.radius));
    influences_.push_back({joint, weight, point.centre, 0});
  };
  for (std::size_t v = 0; v < part.positions.size(); ++v) {
    first_.push_back(influences_.size());
    for (std::size_t i = part.first[v]; i < part.first[v + 1]; ++i)
      add(static_cast<std::size_t>(part.influences[i].joint), part.influences[i].weight, points[i]);
    if (part.first[v] == part.first[v + 1]) add(part.joints.size(), 1, {part.positions[v], 0});
    most_ = std::max(most_, influences_.size() - first_.back());
  }
  first_.push_back(influences_.size());
  for (std::size_t j = 0; j < clouds_.size(); ++j) clouds_[j].centre = low[j] + (high[j] - low[j]) / 2;
  for (Influence& influence : influences_) {
    Cloud& cloud = clouds_[influence.joint];
    influence.distance = grown(norm_above(Vec3(influence.point - cloud.centre)) + cloud.error);
    cloud.radius = std::max(cloud.radius, influence.distance);
  }
}

// A sum of weighted points is off by what the points are, and by two roundings of each partial sum and of
// each point. Partial sums are no longer than the longest point, because weights sum to 1 up to rounding.
std::vector<LinearSkin::JointPlace> LinearSkin::joint_places(const std::vector<MovingTransform>& pose) const {
  std::vector<JointPlace> out(clouds_.size());
  double longest = 0;
  for (std::size_t j = 0; j < clouds_.size(); ++j) {
    const Cloud& cloud = clouds_[j];
    if (!cloud.used) continue;
    const BallMatrix& linear = pose[cloud.node].linear.value;
    const BallVector& origin = pose[cloud.node].origin.value;
    const double norm = norm_above(linear.centre), off = norm_above(origin.centre);
    out[j] = {linear.centre, origin.centre,
              grown(norm * (cloud.error + 2 * kProductRounding * cloud.length) +
                    linear.radius * cloud.length + origin.radius + 4 * kUnitRoundoff * off)};
    longest = std::max(longest, grown(norm * cloud.length + off));
  }
  const double summing = grown(8 * kUnitRoundoff * static_cast<double>(most_ + 1) * longest);
  for (JointPlace& joint_place : out) joint_place.error = grown(joint_place.error + summing);
  return out;
}

double LinearSkin::place(std::size_t v, std::span<const JointPlace> joint_places, Vec3& at) const {
  double error = 0;
  at = Vec3::Zero();
  for (const Influence& influence : of(v)) {
    const JointPlace& joint = joint_places[influence.joint];
    at += influence.weight * (joint.linear * influence.point + joint.origin);
    error += influence.weight * joint.error;
  }
  return grown(error);
}

LinearSkin::JointMotions LinearSkin::motions(const std::vector<MovingTransform>& pose) const {
  JointMotions out;
  out.joints.resize(clouds_.size());
  for (std::size_t j = 0; j < clouds_.size(); ++j) {
    const Cloud& cloud = clouds_[j];
    if (!cloud.used) continue;
    const MovingTransform& map = pose[cloud.node];
    const BallVector centre{cloud.centre, 0};
    const BallVector bend = map.linear.bend * centre + map.origin.bend;
    const double sure = norm_above(bend.centre), around = norm_above(map.linear.bend.centre);
    out.joints[j] = {map.linear.rate * centre + map.origin.rate,
                     map.linear.rate,
                     {grown(sure + bend.radius), grown(around + map.linear.bend.radius)}};
    const double uncertainty = bend.radius + cloud.radius * map.linear.bend.radius;
    if (!std::isfinite(uncertainty + sure + around)) throw Unbounded();
    out.bend = std::max(out.bend, sure + cloud.radius * around + uncertainty);
    out.uncertainty = std::max(out.uncertainty, uncertainty);
  }
  return out;
}

std::vector<LinearSkin::AffineBound> LinearSkin::rate_changes(const JointMotions& before,
                                                              const JointMotions& after) const {
  const auto between = [](const auto& a, const auto& b) {
    return grown(norm_above(decltype(a.centre)(b.centre - a.centre)) + a.radius + b.radius);
  };
  std::vector<AffineBound> out(clouds_.size());
  for (std::size_t j = 0; j < out.size(); ++j)
    out[j] = {between(before.joints[j].rate, after.joints[j].rate),
              between(before.joints[j].rate_around, after.joints[j].rate_around)};
  return out;
}

double LinearSkin::deviation(std::size_t v, std::span<const AffineBound> of_joints) const {
  double sum = 0;
  for (const Influence& influence : of(v)) {
    const AffineBound& joint = of_joints[influence.joint];
    sum += influence.weight * (joint.at_centre + joint.per_distance * influence.distance);
  }
  return grown(sum);
}

double LinearSkin::largest_deviation(std::span<const AffineBound> of_joints) const {
  double largest = 0;
  for (std::size_t j = 0; j < clouds_.size(); ++j)
    if (clouds_[j].used)
      largest = std::max(largest, of_joints[j].at_centre + of_joints[j].per_distance * clouds_[j].radius);
  return grown(largest);
}

}  // namespace cscd::scenes
