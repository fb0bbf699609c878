#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/effects/effect.h"

namespace cscd::scenes {

// Kinematic effects add up. The first effect of a moment begins with the pose at rest. Each effect then
// turns bones about their heads, and all bones that hang on a turned bone are carried along.

// Throws InputError, whose text begins with `who`, unless the shape has bones and every bone has a name of
// its own and comes after its parent.
void require_tree(const Shape& shape, const std::string& who);

// Brings the bones to rest, unless that was done for this moment already.
void pose_from_rest(SceneState& state);

// A function that gives the rotation of one bone about its head, in the axes of the rest pose as the bone
// has carried them along so far. It is called for parents first, and for each bone after the bone has
// followed its parent.
using BoneTurn = std::function<Eigen::Matrix3d(std::size_t bone)>;

// Turns every bone by turn(bone).
void turn_bones(SceneState& state, const BoneTurn& turn);

// The bones with the given names, in ascending order. Names are separated by blanks, and each * in a name
// stands for any text. Throws InputError for a name that no bone has; the text begins with `who` and lists
// the bones.
std::vector<std::size_t> select_bones(const Shape& shape, std::string_view names, const std::string& who);

// A selected bone and its chain. A chain is a bone whose parent is not selected, with the selected bones
// that hang on it without a gap.
struct ChainBone {
  std::size_t bone;
  std::size_t chain;   // chains are numbered in the order of their first bones
  std::size_t place;   // number of bones of the chain before this bone
  std::size_t length;  // the largest place in the chain
};
// The selected bones with their chains. Throws as select_bones does.
std::vector<ChainBone> select_chains(const Shape& shape, std::string_view names, const std::string& who);

}  // namespace cscd::scenes
