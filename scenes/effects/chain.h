#pragma once

#include <string>
#include <vector>

#include "scenes/effects/effect.h"

namespace cscd::scenes {

// Throws InputError, beginning with `who`, unless every bone hangs on the one before it and starts where that
// ends.
void require_chain(const Shape& shape, const std::string& who);

// The joints of a chain: the first head, then all tails. [bones + 1]
void read_joints(const SceneState& state, std::vector<Vec3>& joints);

// Sets bones and rotations from the joints. The steady bone turns from its present direction to the new one
// on the shortest way; going outwards from it, every bone has the rotation of its neighbour followed by the
// smallest turn into its own direction: the chain bends without twisting.
void pose_chain(const std::vector<Vec3>& joints, SceneState& state);

}  // namespace cscd::scenes
