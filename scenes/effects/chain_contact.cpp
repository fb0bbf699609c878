#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "scenes/effects/chain.h"
#include "scenes/effects/effect.h"

namespace cscd::scenes {
namespace {

// Keeps a chain off itself and off the floor. Capsules round the bones have centre lines that stay two
// radii and a clearance apart, with Coulomb friction. Contacts are solved by moving positions one after the
// other, as in Mueller et al., "Position based dynamics", VRIPHYS 2006. A step looks at all pairs of bones
// once to find the candidates, and at the candidates in every sweep.

// The closest points of two segments, as shares of the segments' lengths (Ericson, "Real-Time Collision
// Detection", 2005, 5.1.9). Neither segment may be a point.
struct Closest {
  double s, t;
};

Closest closest(const Vec3& p0, const Vec3& p1, const Vec3& q0, const Vec3& q1) {
  const Vec3 p = p1 - p0, q = q1 - q0, r = p0 - q0;
  const double a = p.squaredNorm(), e = q.squaredNorm(), b = p.dot(q), c = p.dot(r), f = q.dot(r);
  const double determinant = a * e - b * b;
  double s = determinant > 1e-12 * a * e ? std::clamp((b * f - c * e) / determinant, 0.0, 1.0) : 0.5;
  double t = (b * s + f) / e;
  if (t < 0) {
    t = 0;
    s = std::clamp(-c / a, 0.0, 1.0);
  } else if (t > 1) {
    t = 1;
    s = std::clamp((b - c) / a, 0.0, 1.0);
  }
  return {s, t};
}

class ChainContact final : public Effect {
 public:
  ChainContact(const Parameters& p, const Shape& shape)
      : apart_(2 * p.number("radius") + p.number("clearance")),
        radius_(p.number("radius")),
        friction_(p.number("friction")),
        has_floor_(p.has("floor")),
        floor_(p.number("floor", 0)),
        iterations_(p.integer("iterations")) {
    require_chain(shape, p.where());
    double shortest = (shape.rig.reference[0].tail - shape.rig.reference[0].head).norm();
    for (const Bone& bone : shape.rig.reference)
      shortest = std::min(shortest, (bone.tail - bone.head).norm());
    // The limit on bending keeps bones apart that are closer along the chain than this.
    skip_ = 1 + static_cast<std::size_t>(std::ceil(1.6 * apart_ / shortest));
  }

  void step(SceneState& state) override {
    read_joints(state, joints_);
    if (before_.empty()) before_ = joints_;
    gather();
    for (int i = 0; i < iterations_; ++i) {
      for (const auto& [a, b] : pairs_) push_apart(a, b);
      if (has_floor_)
        for (std::size_t joint = 0; joint < joints_.size(); ++joint) lift(joint);
    }
    before_ = joints_;
    pose_chain(joints_, state);
  }

 private:
  // Finds the candidates: pairs of bones that may touch in this step.
  void gather() {
    pairs_.clear();
    const double slack = 0.5 * radius_;
    for (std::size_t a = 0; a + 1 < joints_.size(); ++a) {
      const Vec3 middle = (joints_[a] + joints_[a + 1]) / 2;
      const double reach = (joints_[a + 1] - joints_[a]).norm() / 2 + apart_ + slack;
      for (std::size_t b = a + skip_; b + 1 < joints_.size(); ++b) {
        const double limit = reach + (joints_[b + 1] - joints_[b]).norm() / 2;
        if (((joints_[b] + joints_[b + 1]) / 2 - middle).squaredNorm() < limit * limit)
          pairs_.push_back({a, b});
      }
    }
  }

  void push_apart(std::size_t a, std::size_t b) {
    const auto [s, t] = closest(joints_[a], joints_[a + 1], joints_[b], joints_[b + 1]);
    const double w[4] = {1 - s, s, 1 - t, t};
    const Vec3 gap = w[2] * joints_[b] + w[3] * joints_[b + 1] - w[0] * joints_[a] - w[1] * joints_[a + 1];
    const double distance = gap.norm();
    if (distance >= apart_ || distance == 0) return;
    const double share = w[0] * w[0] + w[1] * w[1] + w[2] * w[2] + w[3] * w[3];
    const double depth = apart_ - distance;
    Vec3 move = depth / distance * gap;  // move of b relative to a
    const Vec3 slid = w[2] * (joints_[b] - before_[b]) + w[3] * (joints_[b + 1] - before_[b + 1]) -
                      w[0] * (joints_[a] - before_[a]) - w[1] * (joints_[a + 1] - before_[a + 1]);
    const Vec3 normal = gap / distance;
    move -= rubbed(slid - slid.dot(normal) * normal, depth);
    joints_[a] -= w[0] / share * move;
    joints_[a + 1] -= w[1] / share * move;
    joints_[b] += w[2] / share * move;
    joints_[b + 1] += w[3] / share * move;
  }

  // Moves a joint up to its height above the floor.
  void lift(std::size_t joint) {
    const double depth = floor_ + apart_ / 2 - joints_[joint].z();
    if (depth <= 0) return;
    Vec3 slid = joints_[joint] - before_[joint];
    slid.z() = 0;
    joints_[joint] -= rubbed(slid, depth);
    joints_[joint].z() += depth;
  }

  // The part of a slip that friction undoes.
  Vec3 rubbed(const Vec3& slip, double depth) const {
    const double length = slip.norm();
    if (length == 0) return Vec3::Zero();
    return std::min(1.0, friction_ * depth / length) * slip;
  }

  double apart_, radius_, friction_;
  bool has_floor_;
  double floor_;
  int iterations_;
  std::size_t skip_ = 0;
  std::vector<Vec3> joints_, before_;
  std::vector<std::pair<std::size_t, std::size_t>> pairs_;
};

}  // namespace

EffectRow chain_contact_row() {
  static const ParameterRow rows[] = {
      number_row("radius", "length", "radius of the capsules round the bones", {1e-9, 1e9}),
      number_row("clearance", "length", "gap that is kept between two capsules", {0, 1e9}),
      number_row("friction", "", "Coulomb's coefficient of friction", {0, 1e3}).or_else({0}),
      number_row(
          "floor", "length",
          "height of a floor, on which the chain lies half the clearance high; without it there is no floor")
          .optional(),
      integer_row("iterations", "", "sweeps over the contacts in each substep", {1, 1000}).or_else({8}),
  };
  return {"chain_contact", "capsule contact of a chain of bones with itself and a floor", Pace::substep, rows,
          make_effect<ChainContact>};
}

}  // namespace cscd::scenes
