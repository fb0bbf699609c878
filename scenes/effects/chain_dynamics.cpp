#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "core/base/error.h"
#include "scenes/effects/chain.h"
#include "scenes/effects/effect.h"
#include "scenes/effects/keys.h"
#include "scenes/shape/circle.h"

namespace cscd::scenes {
namespace {

// Position-based dynamics of a chain of bones under gravity, led at its ends (Mueller, Heidelberger,
// Hennix, Ratcliff, "Position based dynamics", VRIPHYS 2006), in small steps as in Macklin et al., "Small
// steps in physics simulation", SCA 2019.
//
// This implementation differs in one respect. The lengths of all bones are solved for together, by
// elimination in the tridiagonal system of the chain (Han, Harada, "Tridiagonal matrix formulation for
// inextensible hair strand simulation", VRIPHYS 2013). So a hanging chain of 100 bones does not stretch,
// and it needs no hundreds of sweeps. The cost of a step is linear in the number of bones.

// The path on which an end is led. Its keys are rows of frame, radius, turns and height, about the vertical
// line through `axis`.
class EndPath {
 public:
  EndPath(const Parameters::Table& keys, const Vec3& axis, const std::string& who)
      : curve_(keys, who), axis_(axis) {}

  // The place of the end at a frame. Returns nullopt before the first key and after the last, because the
  // end is free then.
  std::optional<Vec3> at(double frame) const {
    if (frame < curve_.first_frame() || frame > curve_.last_frame()) return std::nullopt;
    const double radius = curve_.at(frame, 1), height = curve_.at(frame, 3);
    const CirclePoint point = circle_point(curve_.at(frame, 2));
    return Vec3(axis_.x() + radius * point.cosine, axis_.y() + radius * point.sine, axis_.z() + height);
  }

 private:
  KeyCurve curve_;
  Vec3 axis_;
};

class ChainDynamics final : public Effect {
 public:
  ChainDynamics(const Parameters& p, const Shape& shape)
      : gravity_(p.vector("gravity")),
        drag_(p.number("drag")),
        stiffness_(p.number("bend_stiffness")),
        iterations_(p.integer("iterations")) {
    require_chain(shape, p.where());
    const Vec3 axis = p.vector("axis");
    steady_ = static_cast<std::size_t>(p.integer("steady_bone"));
    if (steady_ >= shape.rig.parent.size())
      throw InputError(p.where() + ": parameter steady_bone is " + std::to_string(steady_) +
                       "; the chain has " + std::to_string(shape.rig.parent.size()) +
                       " bones, numbered from 0");
    for (const auto& [end, name] : {std::pair(0, "first_end"), std::pair(1, "last_end")})
      if (p.has(name)) ends_[end].emplace(p.table(name), axis, p.where() + ": parameter " + name);
    const double bend_radius = p.number("bend_radius");
    for (const Bone& bone : shape.rig.reference) lengths_.push_back((bone.tail - bone.head).norm());
    for (std::size_t i = 1; i < lengths_.size(); ++i) {
      // Two chords of a circle of radius bend_radius span at least this length.
      const double chord = (lengths_[i - 1] + lengths_[i]) / 2;
      const double sine = std::min(1.0, chord / (2 * bend_radius));
      least_span_.push_back(2 * chord * std::sqrt(1 - sine * sine));
    }
  }

  void step(SceneState& state) override {
    read_joints(state, joints_);
    if (before_.empty()) before_ = joints_;
    state.steady_bone = steady_;
    predict(state);
    for (int i = 0; i < iterations_; ++i) {
      bend(state.step);
      restore_lengths();
    }
    pose_chain(joints_, state);
  }

 private:
  // Moves the joints by inertia, drag and gravity, and moves led joints to their places. The velocity of a
  // joint contains all of its motion since the last step, by contact too.
  void predict(const SceneState& state) {
    inverse_mass_.assign(joints_.size(), 1.0);
    const double kept = last_step_ > 0 ? std::max(0.0, 1 - drag_ * state.step) * state.step / last_step_ : 0;
    for (std::size_t i = 0; i < joints_.size(); ++i) {
      const Vec3 moved = joints_[i] - before_[i];
      before_[i] = joints_[i];
      joints_[i] += kept * moved + state.step * state.step * gravity_;
    }
    last_step_ = state.step;
    for (const std::size_t end : {std::size_t{0}, std::size_t{1}}) {
      if (!ends_[end]) continue;
      const std::size_t joint = end == 0 ? 0 : joints_.size() - 1;
      if (const std::optional<Vec3> target = ends_[end]->at(state.time)) {
        joints_[joint] = *target;
        inverse_mass_[joint] = 0;
      }
    }
  }

  // Straightens every three neighbouring joints: moves the middle joint towards the line that joins the
  // other two, and moves these two the opposite way.
  void bend(double step) {
    const double soft = std::min(1.0, stiffness_ * step * step);
    for (std::size_t i = 1; i + 1 < joints_.size(); ++i) {
      const Vec3 sag = (joints_[i - 1] + joints_[i + 1]) / 2 - joints_[i];
      const double span = (joints_[i + 1] - joints_[i - 1]).norm();
      double share = soft;
      if (span < least_span_[i - 1]) {
        // The sag of the middle joint at the least span, by Pythagoras.
        const double chord = (lengths_[i - 1] + lengths_[i]) / 2;
        const double most =
            std::sqrt(std::max(0.0, chord * chord - least_span_[i - 1] * least_span_[i - 1] / 4));
        const double length = sag.norm();
        if (length > most) share = std::max(share, 1 - most / length);
      }
      const double weight = inverse_mass_[i] + (inverse_mass_[i - 1] + inverse_mass_[i + 1]) / 4;
      if (weight == 0) continue;
      const Vec3 move = share / weight * sag;
      joints_[i] += inverse_mass_[i] * move;
      joints_[i - 1] -= inverse_mass_[i - 1] / 2 * move;
      joints_[i + 1] -= inverse_mass_[i + 1] / 2 * move;
    }
  }

  // Makes one Newton step towards the lengths of the bones. It solves for all multipliers at once, by Thomas'
  // elimination.
  void restore_lengths() {
    const std::size_t bones = lengths_.size();
    along_.resize(bones);
    upper_.resize(bones);
    multiplier_.resize(bones);
    for (std::size_t i = 0; i < bones; ++i) {
      const Vec3 span = joints_[i + 1] - joints_[i];
      const double length = span.norm();
      along_[i] = span / length;
      double diagonal = inverse_mass_[i] + inverse_mass_[i + 1];
      double right = length - lengths_[i];
      if (i > 0) {
        const double coupling = -inverse_mass_[i] * along_[i - 1].dot(along_[i]);
        diagonal -= coupling * upper_[i - 1];
        right -= coupling * multiplier_[i - 1];
      }
      // The system is singular only if both ends of a taut straight chain are led. This regulariser lets
      // the chain stretch then.
      diagonal += 1e-9;
      upper_[i] = i + 1 < bones ? -inverse_mass_[i + 1] *
                                      along_[i].dot((joints_[i + 2] - joints_[i + 1]).normalized()) / diagonal
                                : 0;
      multiplier_[i] = right / diagonal;
    }
    for (std::size_t i = bones - 1; i-- > 0;) multiplier_[i] -= upper_[i] * multiplier_[i + 1];
    for (std::size_t i = 0; i < bones; ++i) {
      joints_[i] += inverse_mass_[i] * multiplier_[i] * along_[i];
      joints_[i + 1] -= inverse_mass_[i + 1] * multiplier_[i] * along_[i];
    }
  }

  Vec3 gravity_;
  double drag_, stiffness_;
  int iterations_;
  std::size_t steady_ = 0;
  std::optional<EndPath> ends_[2];
  std::vector<double> lengths_;     // [bones]
  std::vector<double> least_span_;  // [bones - 1]: least span of bones i and i + 1 together
  std::vector<Vec3> joints_, before_;
  double last_step_ = 0;
  std::vector<double> inverse_mass_, upper_, multiplier_;
  std::vector<Vec3> along_;
};

}  // namespace

EffectRow chain_dynamics_row() {
  static const ParameterRow rows[] = {
      vector_row("gravity", "length / frame^2", "acceleration of all joints"),
      number_row("drag", "1 / frame", "share of the velocity that is lost", {0, 1e6}),
      number_row("bend_stiffness", "1 / frame^2", "pull of each joint towards a straight chain", {0, 1e9}),
      number_row("bend_radius", "length", "the chain bends no sharper than this", {1e-9, 1e12}),
      integer_row("iterations", "", "sweeps over the constraints in each substep", {1, 1000}).or_else({4}),
      integer_row("steady_bone", "",
                  "number of the bone that does not spin about its axis, such as one that lies on the floor",
                  {0, 1e9})
          .or_else({0}),
      vector_row("axis", "length", "a point of the vertical line about which the ends are led")
          .or_else({0, 0, 0}),
      table_row("first_end", "frame, length, turn, length", 4,
                "keys of frame, radius, turns, height on which the chain's first joint is led; it is free "
                "outside of their frames, and always without them")
          .optional(),
      table_row("last_end", "frame, length, turn, length", 4, "the same for the chain's last joint")
          .optional(),
  };
  return {"chain_dynamics", "position-based dynamics of a chain of bones under gravity, led at its ends",
          Pace::substep, rows, make_effect<ChainDynamics>};
}

}  // namespace cscd::scenes
