#include "scenes/effects/effect.h"

namespace cscd::scenes {

SceneState::SceneState(const Shape& at_rest)
    : shape(at_rest),
      bones(at_rest.rig.reference),
      rotations(at_rest.rig.reference.size(), Eigen::Matrix3d::Identity()),
      positions(at_rest.positions) {}

// One row for each effect, defined in the effect's own file of this folder.
EffectRow chain_contact_row();
EffectRow chain_dynamics_row();
EffectRow cloth_dynamics_row();
EffectRow contact_response_row();
EffectRow keyframes_row();
EffectRow skinning_dual_quaternion_row();
EffectRow skinning_linear_row();
EffectRow spring_follow_row();
EffectRow travelling_wave_row();
EffectRow twist_row();
EffectRow volume_bulge_row();

std::span<const EffectRow> effects() {
  static const EffectRow rows[] = {
      keyframes_row(),
      travelling_wave_row(),
      twist_row(),
      chain_dynamics_row(),
      chain_contact_row(),
      spring_follow_row(),
      skinning_linear_row(),
      skinning_dual_quaternion_row(),
      volume_bulge_row(),
      cloth_dynamics_row(),
      contact_response_row(),
  };
  return rows;
}

}  // namespace cscd::scenes
