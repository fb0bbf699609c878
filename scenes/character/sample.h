#pragma once

#include <vector>

#include "scenes/character/character.h"

// Values of an animation at a time in seconds.
namespace cscd::scenes {

// Keys of whole values: the first key's value holds before it, and the last key's value after it.
Vec3 sample(const std::vector<Key<Vec3>>& keys, double seconds);
Quaternion sample(const std::vector<Key<Quaternion>>& keys, double seconds);

// A curve with at least one key, between its keys and beyond them (Extrapolation). However far a time lies
// beyond the keys and however often they are repeated, the cost is that of one look-up.
double sample(const Curve& curve, double seconds);
// Returns the slope with which a curve of at least two keys leaves its first key or arrives at its last key.
double end_slope(const std::vector<Key<double>>& keys, bool first);

// Returns the shares of the weights of an animation's layers, each in [0, 1]. The functions below take them.
std::vector<double> layer_shares(const Animation& animation, double seconds);

// What all layers make together. The three parts of a Layered<3> are those of a move or of a scaling.
Vec3 sample(const Layered<3>& layered, const std::vector<double>& shares, double seconds);
double sample(const Layered<1>& layered, const std::vector<double>& shares, double seconds);
Quaternion sample(const EulerAngles& angles, const std::vector<double>& shares, double seconds);

// Returns the weight of a morph target where an animation drives it to a value (MorphTarget::response).
double weight_of(const MorphTarget& target, double driven);

}  // namespace cscd::scenes
