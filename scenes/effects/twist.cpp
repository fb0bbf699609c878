#include "core/base/error.h"
#include "scenes/effects/keys.h"
#include "scenes/effects/rotation.h"
#include "scenes/effects/tree_pose.h"

namespace cscd::scenes {
namespace {

// Wrings chains of bones. Each bone but the first turns about its own axis against its parent bone. All
// bones turn by the same share of the turns that the keys give between the first bone and the last bone.
class Twist final : public Effect {
 public:
  Twist(const Parameters& p, const Shape& shape)
      : turns_(p.table("turns"), p.where() + ": parameter turns"),
        share_(shape.rig.parent.size(), 0),
        axis_(shape.rig.parent.size()) {
    require_tree(shape, p.where());
    for (const ChainBone& at : select_chains(shape, p.text("bones"), p.where())) {
      if (at.length == 0)
        throw InputError(p.where() + ": bone " + shape.bone_names[at.bone] +
                         " is a chain of its own; choose chains of at least two bones");
      const Bone& bone = shape.rig.reference[at.bone];
      if (bone.head == bone.tail)
        throw InputError(p.where() + ": bone " + shape.bone_names[at.bone] + " has no length, hence no axis");
      axis_[at.bone] = (bone.tail - bone.head).normalized();
      if (at.place > 0) share_[at.bone] = 1 / static_cast<double>(at.length);
    }
  }

  void step(SceneState& state) override {
    pose_from_rest(state);
    const double turns = turns_.at(state.time, 1);
    if (turns == 0) return;
    turn_bones(state, [&](std::size_t bone) -> Eigen::Matrix3d {
      if (share_[bone] == 0) return Eigen::Matrix3d::Identity();
      return rotation_about(axis_[bone], share_[bone] * turns);
    });
  }

 private:
  KeyCurve turns_;
  std::vector<double> share_;  // [bones]
  std::vector<Vec3> axis_;     // [bones]; set for the bones of chains
};

}  // namespace

EffectRow twist_row() {
  static const ParameterRow rows[] = {
      text_row("bones", "names of the chains' bones, with blanks between and * for any text"),
      table_row("turns", "frame, turn", 2,
                "keys of frame and turns of a chain's last bone against its first"),
  };
  return {"twist", "turns the bones of a chain about the chain's own axis", Pace::substep, rows,
          make_effect<Twist>};
}

}  // namespace cscd::scenes
