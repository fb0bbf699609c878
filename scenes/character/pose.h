#pragma once

#include <span>
#include <vector>

#include "scenes/character/character.h"

namespace cscd::scenes {

// Where every node stands: [nodes] maps, each from the node's coordinates to the world's.
using Pose = std::vector<Transform>;

// [parts][targets of the part] weights of the morph targets.
using MorphWeights = std::vector<std::vector<double>>;

// The node's move, rotation and scale at rest: as the file writes them, or else taken out of the node's map.
ScaleTurnMove parts_at_rest(const Node& node);

// The pose in which no animation moves the nodes.
Pose rest_pose(const Character& character);

// Returns the pose in which the vertices were bound to the joints, as far as the offsets of the joints
// tell. The offsets of one part only say how its joints stood to each other, so the part's topmost joint is
// placed where it stands at rest. A node that is no joint stands to its parent as at rest.
Pose bind_pose(const Character& character);

// Returns the pose at a time of an animation, in seconds. Values go from key to key as each key says
// (Between), and beyond the keys as each curve says (Extrapolation); without a word of the curve, the first
// key's value holds before it, and the last key's value after it. Nodes that the animation does not drive
// stay at rest.
Pose pose_at(const Character& character, const Animation& animation, double seconds);

// The weights of the morph targets at rest, at a time of an animation in seconds, and at the share s in
// [0, 1] of the straight way from `a` to `b`.
MorphWeights rest_weights(const Character& character);
MorphWeights weights_at(const Character& character, const Animation& animation, double seconds);
MorphWeights blend(const MorphWeights& a, const MorphWeights& b, double s);

// Returns the pose at the share s in [0, 1] of the way between two poses. Every node moves relative to its
// parent (see blend in transform.h), so that limbs keep together.
Pose blend(const Character& character, const Pose& a, const Pose& b, double s);

// Writes the positions of all vertices to `out`, the parts one after the other. Displacements of morph
// targets are added by their weights first. Then the joints move each vertex by linear blend skinning: the
// vertex goes to the weighted mean of the places to which its joints would take it. A vertex with a share of
// dual quaternions goes by this share towards the place that DualSkin gives it instead. The overload without
// weights uses the weights at rest. Throws InputError where DualSkin does.
void skin(const Character& character, const Pose& pose, const MorphWeights& weights, std::vector<Vec3>& out);
void skin(const Character& character, const Pose& pose, std::vector<Vec3>& out);

}  // namespace cscd::scenes
