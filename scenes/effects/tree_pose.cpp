#include "scenes/effects/tree_pose.h"

#include <algorithm>
#include <set>

#include "core/base/error.h"
#include "scenes/effects/rotation.h"

namespace cscd::scenes {
namespace {

// True if the pattern stands for the name.
bool matches(std::string_view pattern, std::string_view name) {
  if (pattern.empty()) return name.empty();
  if (pattern.front() != '*')
    return !name.empty() && name.front() == pattern.front() && matches(pattern.substr(1), name.substr(1));
  for (std::size_t skipped = 0; skipped <= name.size(); ++skipped)
    if (matches(pattern.substr(1), name.substr(skipped))) return true;
  return false;
}

}  // namespace

void require_tree(const Shape& shape, const std::string& who) {
  const Rig& rig = shape.rig;
  if (rig.parent.empty()) throw InputError(who + ": the shape has no bones; the effect needs some");
  std::set<std::string_view> names(shape.bone_names.begin(), shape.bone_names.end());
  if (shape.bone_names.size() != rig.parent.size() || names.size() != rig.parent.size())
    throw InputError(who + ": the effect needs a shape whose bones have a name each");
  for (std::size_t bone = 0; bone < rig.parent.size(); ++bone)
    if (static_cast<int>(rig.parent[bone]) >= static_cast<int>(bone))
      throw InputError(who + ": bone " + shape.bone_names[bone] +
                       " comes before its parent; the effect needs parents first");
}

void pose_from_rest(SceneState& state) {
  if (state.posed == state.time) return;
  state.posed = state.time;
  state.bones = state.shape.rig.reference;
  std::fill(state.rotations.begin(), state.rotations.end(), Eigen::Matrix3d::Identity());
}

void turn_bones(SceneState& state, const BoneTurn& turn) {
  const Rig& rig = state.shape.rig;
  const std::vector<Bone> before = state.bones;
  std::vector<Eigen::Matrix3d> change(before.size());  // change of each bone's rotation, in world axes
  for (std::size_t bone = 0; bone < before.size(); ++bone) {
    Bone& now = state.bones[bone];
    Eigen::Matrix3d& rotation = state.rotations[bone];
    const Eigen::Matrix3d backwards = rotation.transpose();
    if (rig.parent[bone] != BoneId{-1}) {
      const std::size_t parent = +rig.parent[bone];
      now.head = state.bones[parent].head + rotated(change[parent], before[bone].head - before[parent].head);
      now.tail = now.head + rotated(change[parent], before[bone].tail - before[bone].head);
      rotation = composed(change[parent], rotation);
    }
    rotation = composed(rotation, turn(bone));
    change[bone] = composed(rotation, backwards);
    now.tail = now.head + rotated(change[bone], before[bone].tail - before[bone].head);
  }
}

std::vector<std::size_t> select_bones(const Shape& shape, std::string_view names, const std::string& who) {
  std::vector<bool> chosen(shape.bone_names.size());
  while (!names.empty()) {
    const std::string_view pattern = names.substr(0, names.find(' '));
    names.remove_prefix(std::min(names.size(), pattern.size() + 1));
    bool found = false;
    std::string known;
    for (std::size_t bone = 0; bone < chosen.size(); ++bone) {
      if (matches(pattern, shape.bone_names[bone])) chosen[bone] = found = true;
      known += (known.empty() ? "" : ", ") + shape.bone_names[bone];
    }
    if (!found)
      throw InputError(who + ": no bone is called " + std::string(pattern) + "; known are: " + known);
  }
  std::vector<std::size_t> bones;
  for (std::size_t bone = 0; bone < chosen.size(); ++bone)
    if (chosen[bone]) bones.push_back(bone);
  return bones;
}

std::vector<ChainBone> select_chains(const Shape& shape, std::string_view names, const std::string& who) {
  std::vector<ChainBone> chosen;
  std::vector<std::size_t> length;                                 // [chains]
  std::vector<std::size_t> at(shape.rig.parent.size(), SIZE_MAX);  // [bones]: place in `chosen`
  for (const std::size_t bone : select_bones(shape, names, who)) {
    const BoneId parent = shape.rig.parent[bone];
    at[bone] = chosen.size();
    if (parent == BoneId{-1} || at[+parent] == SIZE_MAX) {
      chosen.push_back({bone, length.size(), 0, 0});
      length.push_back(0);
    } else {
      const ChainBone before = chosen[at[+parent]];
      chosen.push_back({bone, before.chain, before.place + 1, 0});
      length[before.chain] = std::max(length[before.chain], before.place + 1);
    }
  }
  for (ChainBone& bone : chosen) bone.length = length[bone.chain];
  return chosen;
}

}  // namespace cscd::scenes
