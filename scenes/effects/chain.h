#pragma once

#include <string>
#include <vector>

#include "scenes/effects/effect.h"

namespace cscd::scenes {

// Throws InputError, whose text begins with `who`, unless the bones of the shape form a chain of at least
// two bones: every bone hangs on the previous bone and starts at its end.
void require_chain(const Shape& shape, const std::string& who);

// Writes the joints of a chain to `joints`, [bones + 1]: the head of the first bone, then all tails.
void read_joints(const SceneState& state, std::vector<Vec3>& joints);

// Sets the bones and rotations of the state from the joints [bones + 1]. The steady bone (SceneState) turns
// the shortest way from its present direction to its new direction. Outwards from the steady bone, the
// rotation of every bone is the rotation of its neighbour followed by the smallest turn into the bone's own
// direction. So the chain bends without twisting.
void pose_chain(const std::vector<Vec3>& joints, SceneState& state);

}  // namespace cscd::scenes
