#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/effects/effect.h"

namespace cscd::scenes {

// How kinematic effects add up. The first of a moment begins with the pose at rest; each then turns bones
// about their heads, and what hangs on a bone is carried along.

// Throws InputError, beginning with `who`, unless every bone has a name of its own and comes after its
// parent.
void require_tree(const Shape& shape, const std::string& who);

// Brings the bones to rest, unless that was done for this moment already.
void pose_from_rest(SceneState& state);

// The rotation of one bone about its head, in the axes of the rest pose as the bone has carried them along so
// far. Asked for parents first, when the bone has followed its parent.
using BoneTurn = std::function<Eigen::Matrix3d(std::size_t bone)>;

// Turns every bone.
void turn_bones(SceneState& state, const BoneTurn& turn);

// The bones of these names, with a blank between names and any number of * for any text each. Throws
// InputError, beginning with `who` and listing the bones, for a name that none has.
std::vector<std::size_t> select_bones(const Shape& shape, std::string_view names, const std::string& who);

// A bone among those selected: a chain is a bone whose parent is not selected, with its selected descendants.
struct ChainBone {
  std::size_t bone;
  std::size_t chain;   // chains in the order of their first bones
  std::size_t place;   // how many bones of the chain lead to it
  std::size_t length;  // largest place of the chain
};
std::vector<ChainBone> select_chains(const Shape& shape, std::string_view names, const std::string& who);

}  // namespace cscd::scenes
