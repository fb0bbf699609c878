#include "scenes/effects/effect.h"

namespace cscd::scenes {

SceneState::SceneState(const Shape& at_rest)
    : shape(at_rest),
      bones(at_rest.rig.reference),
      rotations(at_rest.rig.reference.size(), Eigen::Matrix3d::Identity()),
      positions(at_rest.positions) {}

}  // namespace cscd::scenes
