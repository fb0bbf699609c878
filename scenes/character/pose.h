#pragma once

#include <span>
#include <vector>

#include "scenes/character/character.h"

namespace cscd::scenes {

// Where every node stands: one map a node, from its coordinates to the world's.
using Pose = std::vector<Transform>;

Pose rest_pose(const Character& character);

// The pose in which the vertices were bound to the joints, where the offsets say so. The offsets of one part
// are relative to each other; its topmost joint stands where it is at rest. Nodes that are no joints stand to
// their parents as at rest.
Pose bind_pose(const Character& character);

// The pose at a time of an animation: keys are joined by straight lines (rotations: the shorter way), and
// held before the first and after the last. Nodes that it does not drive are at rest.
Pose pose_at(const Character& character, const Animation& animation, double seconds);

// Between two poses: every node moves relative to its parent (see blend in transform.h), so that limbs keep
// together.
Pose blend(const Character& character, const Pose& a, const Pose& b, double s);

// Positions of all vertices, the parts one after the other (linear blend skinning: the weighted mean of where
// the joints would take a vertex).
void skin(const Character& character, const Pose& pose, std::vector<Vec3>& out);

}  // namespace cscd::scenes
