#include "core/base/error.h"
#include "scenes/effects/rotation.h"
#include "scenes/effects/tree_pose.h"

namespace cscd::scenes {
namespace {

// Secondary motion: bones lag behind their pose and swing past it.
//
// A point mass sits at the end of each bone. A damped spring draws the mass to its goal: the place of the
// bone's end in the pose, carried along by the parent bones. The bone turns the shortest way to its mass,
// and the mass is put back to the bone's length, as in position-based dynamics (Mueller et al., VRIPHYS
// 2006). Each step is an implicit Euler step, and masses stay on spheres round the heads of their bones. So
// nothing grows without bound, whatever the stiffness, the damping and the step are.
class SpringFollow final : public Effect {
 public:
  SpringFollow(const Parameters& p, const Shape& shape)
      : stiffness_(p.number("stiffness")), damping_(p.number("damping")), mass_(shape.rig.parent.size()) {
    require_tree(shape, p.where());
    for (const std::size_t bone : select_bones(shape, p.text("bones"), p.where())) {
      const Bone& rest = shape.rig.reference[bone];
      const double length = (rest.tail - rest.head).norm();
      if (length == 0)
        throw InputError(p.where() + ": bone " + shape.bone_names[bone] + " has no length; leave it out");
      mass_[bone] = {length, rest.tail, Vec3::Zero()};
    }
  }

  void step(SceneState& state) override {
    const double h = state.step;
    turn_bones(state, [&](std::size_t bone) -> Eigen::Matrix3d {
      Mass& mass = mass_[bone];
      if (mass.length == 0) return Eigen::Matrix3d::Identity();
      const Bone& goal = state.bones[bone];
      const Vec3 pull = h * stiffness_ * (goal.tail - mass.place);
      const Vec3 velocity = (mass.velocity + pull) / (1 + h * damping_ + h * h * stiffness_);
      const Vec3 wanted = (goal.tail - goal.head).normalized();
      const Vec3 out = mass.place + h * velocity - goal.head;
      const Vec3 found = out.norm() > 1e-9 * mass.length ? Vec3(out.normalized()) : wanted;
      const Vec3 place = goal.head + mass.length * found;
      mass.velocity = (place - mass.place) / h;
      mass.place = place;
      // Take the turn of the bone in the world into the axes that the bone has carried along.
      const Eigen::Matrix3d& rotation = state.rotations[bone];
      return composed(rotation.transpose(), composed(smallest_rotation(wanted, found), rotation));
    });
  }

 private:
  struct Mass {
    double length = 0;  // length of the bone; 0 for a bone without a mass
    Vec3 place = Vec3::Zero(), velocity = Vec3::Zero();
  };
  double stiffness_, damping_;
  std::vector<Mass> mass_;  // [bones]
};

}  // namespace

EffectRow spring_follow_row() {
  static const ParameterRow rows[] = {
      text_row("bones", "names of the bones that lag, with blanks between and * for any text"),
      number_row("stiffness", "1 / frame^2", "pull per distance from the pose", {0, 1e9}),
      number_row("damping", "1 / frame", "share of the velocity that is lost", {0, 1e9}),
  };
  return {"spring_follow", "lets bones lag behind their pose on damped springs", Pace::substep, rows,
          make_effect<SpringFollow>};
}

}  // namespace cscd::scenes
