#pragma once

#include <span>
#include <vector>

#include "scenes/character/character.h"

namespace cscd::scenes {

// Where every node stands: one map a node, from its coordinates to the world's.
using Pose = std::vector<Transform>;

// By part, one weight for each of its morph targets.
using MorphWeights = std::vector<std::vector<double>>;

Pose rest_pose(const Character& character);

// The pose in which the vertices were bound to the joints, where the offsets say so. The offsets of one part
// are relative to each other; its topmost joint stands where it is at rest. Nodes that are no joints stand to
// their parents as at rest.
Pose bind_pose(const Character& character);

// The pose at a time of an animation: keys are joined as each says (Between), and held before the first and
// after the last. Nodes that it does not drive are at rest.
Pose pose_at(const Character& character, const Animation& animation, double seconds);

MorphWeights rest_weights(const Character& character);
MorphWeights weights_at(const Character& character, const Animation& animation, double seconds);
MorphWeights blend(const MorphWeights& a, const MorphWeights& b, double s);

// Between two poses: every node moves relative to its parent (see blend in transform.h), so that limbs keep
// together.
Pose blend(const Character& character, const Pose& a, const Pose& b, double s);

// Positions of all vertices, the parts one after the other: morph targets are added by their weights, then
// joints move what came of it (linear blend skinning: the weighted mean of where the joints would take a
// vertex). Without weights, those at rest.
void skin(const Character& character, const Pose& pose, const MorphWeights& weights, std::vector<Vec3>& out);
void skin(const Character& character, const Pose& pose, std::vector<Vec3>& out);

}  // namespace cscd::scenes
