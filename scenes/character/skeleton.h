#pragma once

#include <span>
#include <vector>

#include "core/mesh/rig.h"
#include "scenes/character/character.h"
#include "scenes/character/pose.h"

namespace cscd::scenes {

// The bones of a rig: the nodes that move some of the vertices in use. A bone runs from its node to the
// mean of its child bones. A bone without children runs to the mean of the vertices that it moves, so that
// it ends inside the body. Joints that move nothing (controls, helpers) are no bones; their children hang
// on the next bone above.
struct Skeleton {
  std::vector<int> node;           // [bones]; ascending
  std::vector<BoneId> parent;      // [bones]; BoneId{-1} for a root
  std::vector<Vec3> tail_in_node;  // [bones]; where the bone ends, in coordinates of its node
};

// Makes the skeleton. `used` [vertices] tells which vertices are in use, `bound` is the pose in which the
// bones are measured, and `positions` [vertices] are the positions of the vertices in that pose.
Skeleton make_skeleton(const Character& character, const Pose& bound, std::span<const Vec3> positions,
                       const std::vector<bool>& used);

// Writes the head and the tail of every bone in a pose to `out`, [bones].
void bones_at(const Skeleton& skeleton, const Pose& pose, std::vector<Bone>& out);

}  // namespace cscd::scenes
