#include "scenes/motion/skin_jets.h"

#include <algorithm>

namespace cscd::scenes {
namespace {

void add_scaled(BallVector& sum, double weight, const BallVector& x) {
  sum.centre += weight * x.centre;
  sum.radius = grown(sum.radius + weight * x.radius +
                     2 * kUnitRoundoff * (weight * x.centre.norm() + sum.centre.norm()));
}

void add_scaled(MovingVector& sum, double weight, const MovingVector& x) {
  add_scaled(sum.value, weight, x.value);
  add_scaled(sum.rate, weight, x.rate);
  add_scaled(sum.bend, weight, x.bend);
}

MovingVector fixed_point(const Vec3& x) {
  return {{x, 0}, {}, {}};
}

// A quaternion of the rotation with these columns, up to its length: Shepperd's formula by the largest of its
// four numbers, which is far from zero throughout a span over which the rotation turns little.
JetQuaternion quaternion_of(const JetRotation& c) {
  const Jet trace = c[0][0] + c[1][1] + c[2][2];
  const double x = c[0][0].value.middle(), y = c[1][1].value.middle(), z = c[2][2].value.middle();
  if (x + y + z > 0) return {1 + trace, c[1][2] - c[2][1], c[2][0] - c[0][2], c[0][1] - c[1][0]};
  if (x >= y && x >= z)
    return {c[1][2] - c[2][1], 1 + c[0][0] - c[1][1] - c[2][2], c[0][1] + c[1][0], c[2][0] + c[0][2]};
  if (y >= z)
    return {c[2][0] - c[0][2], c[0][1] + c[1][0], 1 + c[1][1] - c[0][0] - c[2][2], c[1][2] + c[2][1]};
  return {c[0][1] - c[1][0], c[2][0] + c[0][2], c[1][2] + c[2][1], 1 + c[2][2] - c[0][0] - c[1][1]};
}

// A map as an upper triangle, of which the diagonal is the scaling of dual quaternions, and a rotation after
// it (parts_of, Gram-Schmidt). The shears above the diagonal, in the order 01, 02, 12, are what files round.
struct ScaledAxes {
  JetRotation axis;
  JetVector scale, shear;
};
ScaledAxes axes_of(const MovingTransform& map) {
  const JetRotation c = box_around(map.linear);
  ScaledAxes out;
  const Jet first = norm(c[0]);
  out.axis[0] = reciprocal(first) * c[0];
  const Jet along = dot(out.axis[0], c[1]);
  const JetVector rest = c[1] - along * out.axis[0];
  const Jet second = norm(rest);
  out.axis[1] = reciprocal(second) * rest;
  out.axis[2] = cross(out.axis[0], out.axis[1]);
  out.scale = {first, second, dot(out.axis[2], c[2])};
  out.shear = {along, dot(out.axis[0], c[2]), dot(out.axis[1], c[2])};
  return out;
}

// The vector w of the antisymmetric part of a matrix, (w x) v for all v, as a quaternion.
BallQuaternion turning_of(const BallMatrix& m) {
  const auto& c = m.centre;
  Eigen::Vector4d w;
  w << (c(2, 1) - c(1, 2)) / 2, (c(0, 2) - c(2, 0)) / 2, (c(1, 0) - c(0, 1)) / 2, 0;
  return {w, grown(m.radius + kProductRounding * c.norm())};
}

// The quaternion of a rotation over a span of time, from what it is in the middle: it turns by half the
// angular velocity w, so that it leaves its middle by at most |w| / 4 times the length of the span; q' = w q
// / 2.
MovingQuaternion turn_of(const MovingMatrix& axes, const ScaledAxes& middle, double seconds) {
  const JetQuaternion at = unit_of(quaternion_of(middle.axis));
  const BallQuaternion w = turning_of(axes.rate * transposed(axes.value)),
                       growth = turning_of(axes.bend * transposed(axes.value));
  MovingQuaternion q;
  double squares = 0;
  for (int k = 0; k < 4; ++k) {
    const Interval& x = at[static_cast<std::size_t>((k + 1) % 4)].value;
    q.value.centre[k] = x.middle();
    squares += x.width() * x.width();
  }
  q.value.radius = grown(std::sqrt(squares) + (norm_above(w.centre) + w.radius) * seconds / 4);
  q.rate = 0.5 * (w * q.value);
  q.bend = 0.5 * (growth * q.value + w * q.rate);
  return q;
}

}  // namespace

std::vector<BallVector> points_in_joints(const Part& part) {
  std::vector<BallVector> out;
  out.reserve(part.influences.size());
  for (std::size_t v = 0; v < part.positions.size(); ++v)
    for (std::size_t i = part.first[v]; i < part.first[v + 1]; ++i) {
      const Joint& joint = part.joints[static_cast<std::size_t>(part.influences[i].joint)];
      const MovingTransform offset = fixed(joint.offset);
      out.push_back(moved(offset, norms_of(offset), {part.positions[v], 0}).value);
    }
  return out;
}

SkinJets::SkinJets(const Part& part, const std::vector<BallVector>& points, const PoseJets::Nodes& pose,
                   std::vector<Jet> weights)
    : part_(part), points_(points), pose_(pose.over), weights_(std::move(weights)) {
  if (!part.dual_quaternion.empty())
    for (const Joint& joint : part.joints) {
      const auto node = static_cast<std::size_t>(joint.node);
      const MovingTransform offset = fixed(joint.offset);
      const ScaledAxes own = axes_of(composed(pose.over[node], offset));
      const MovingMatrix axes = ball_around(own.axis);
      rigid_.push_back({turn_of(axes, axes_of(composed(pose.middle[node], offset)), 2 * pose.half), axes,
                        own.scale, own.shear});
    }
  norms_.resize(pose_.size());
  norms_[static_cast<std::size_t>(part.node)] = norms_of(pose_[static_cast<std::size_t>(part.node)]);
  for (const Joint& joint : part.joints) {
    const auto node = static_cast<std::size_t>(joint.node);
    norms_[node] = norms_of(pose_[node]);
  }
  for (const Jet& weight : weights_) morphs_ = morphs_ || !weight.is_still() || !weight.value.is_zero();
}

// Where morph targets bring a vertex before joints move it.
MovingVector SkinJets::point(std::size_t v) const {
  MovingVector out = fixed_point(part_.positions[v]);
  const auto add = [](BallVector& to, const Interval& weight, const Vec3& d) {
    const double middle = weight.middle(), off = grown(std::max(weight.high - middle, middle - weight.low));
    to.centre += middle * d;
    to.radius = grown(to.radius + off * d.norm() +
                      2 * kUnitRoundoff * (std::abs(middle) * d.norm() + to.centre.norm()));
  };
  for (std::size_t t = 0; t < weights_.size(); ++t) {
    const Vec3& d = part_.targets[t].displacements[v];
    if (d.isZero(0)) continue;
    add(out.value, weights_[t].value, d);
    add(out.rate, weights_[t].rate, d);
    add(out.bend, weights_[t].bend, d);
  }
  return out;
}

MovingVector SkinJets::taken_by(int node, const MovingVector& at) const {
  const auto n = static_cast<std::size_t>(node);
  return morphs_ ? pose_[n](at) : moved(pose_[n], norms_[n], at.value);
}

MovingVector SkinJets::taken_by_influence(std::size_t influence, const MovingVector& at) const {
  const Joint& joint = part_.joints[static_cast<std::size_t>(part_.influences[influence].joint)];
  return taken_by(joint.node, morphs_ ? fixed(joint.offset)(at) : MovingVector{points_[influence], {}, {}});
}

MovingVector SkinJets::vertex(std::size_t v) const {
  const MovingVector at = morphs_ ? point(v) : fixed_point(part_.positions[v]);
  const std::size_t first = part_.first[v], last = part_.first[v + 1];
  if (first == last) return taken_by(part_.node, at);
  const double dual_share = part_.dual_quaternion.empty() ? 0 : part_.dual_quaternion[v];
  MovingVector sum{};
  if (dual_share < 1)
    for (std::size_t i = first; i < last; ++i)
      add_scaled(sum, part_.influences[i].weight, taken_by_influence(i, at));
  if (dual_share == 0) return sum;
  const MovingVector dual = by_dual_quaternions(v, at);
  return dual_share == 1 ? dual : (1 - dual_share) * sum + dual_share * dual;
}

// The blend of rigid motions does not depend on where the part and the world have their origins. So the point
// itself is the part's origin here, and a place near where the joints take it is the world's. What a joint's
// motion then moves by, t, is small, and so is all that is uncertain of it. With r the sum of the rotations
// and d that of the products of t / 2 and the rotations, the point is at 2 d r* / |r|^2.
MovingVector SkinJets::by_dual_quaternions(std::size_t v, const MovingVector& at) const {
  const std::size_t first = part_.first[v], last = part_.first[v + 1];
  const auto rigid = [this](std::size_t i) -> const Rigid& {
    return rigid_[static_cast<std::size_t>(part_.influences[i].joint)];
  };
  std::size_t heaviest = first;
  JetVector scale{};
  Vec3 near = Vec3::Zero();
  std::vector<MovingVector> taken;
  for (std::size_t i = first; i < last; ++i) {
    if (part_.influences[i].weight > part_.influences[heaviest].weight) heaviest = i;
    scale = scale + Jet(part_.influences[i].weight) * rigid(i).scale;
    taken.push_back(taken_by_influence(i, at));
    near += part_.influences[i].weight * taken.back().value.centre;
  }
  MovingQuaternion real{}, dual{};
  const JetVector point = box_around(at);
  for (std::size_t i = first; i < last; ++i) {
    const Rigid& own = rigid(i);
    // The scalings of all joints are averaged and nothing shears, while the joint's map has its own of both.
    const JetVector off = last == first + 1 ? JetVector() : scale - own.scale;
    const JetVector rest_box{off[0] * point[0] - own.shear[0] * point[1] - own.shear[1] * point[2],
                             off[1] * point[1] - own.shear[2] * point[2], off[2] * point[2]};
    const MovingVector rest = ball_around(rest_box);
    const MovingVector t = taken[i - first] + own.axes * rest + MovingVector{{-near, 0}, {}, {}};
    const auto pure = [](const BallVector& x) {
      return BallQuaternion{{x.centre[0], x.centre[1], x.centre[2], 0}, x.radius};
    };
    const Interval along = dot(rigid(heaviest).turn.value, own.turn.value);
    if (along.holds(0)) throw Unbounded();
    const double weight = along.low < 0 ? -part_.influences[i].weight : part_.influences[i].weight;
    real = real + weight * own.turn;
    dual = dual + (0.5 * weight) * (MovingQuaternion{pure(t.value), pure(t.rate), pure(t.bend)} * own.turn);
  }
  const auto conjugate = [](const BallQuaternion& q) {
    return BallQuaternion{{-q.centre[0], -q.centre[1], -q.centre[2], q.centre[3]}, q.radius};
  };
  const MovingQuaternion product =
      dual * MovingQuaternion{conjugate(real.value), conjugate(real.rate), conjugate(real.bend)};
  const auto vector = [](const BallQuaternion& q) { return BallVector{q.centre.head<3>(), q.radius}; };
  const Jet squared(dot(real.value, real.value), 2 * dot(real.value, real.rate),
                    2 * (dot(real.rate, real.rate) + dot(real.value, real.bend)));
  const JetVector way =
      box_around(MovingVector{vector(product.value), vector(product.rate), vector(product.bend)});
  return ball_around(Jet(2) * (reciprocal(squared) * way)) + MovingVector{{near, 0}, {}, {}};
}

}  // namespace cscd::scenes
