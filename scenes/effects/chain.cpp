#include "scenes/effects/chain.h"

#include "core/base/error.h"
#include "scenes/effects/rotation.h"

namespace cscd::scenes {
namespace {

Vec3 direction(const Bone& bone) {
  return (bone.tail - bone.head).normalized();
}

}  // namespace

void require_chain(const Shape& shape, const std::string& who) {
  const Rig& rig = shape.rig;
  for (std::size_t bone = 0; bone < rig.parent.size(); ++bone) {
    const bool linked = static_cast<int>(rig.parent[bone]) == static_cast<int>(bone) - 1 &&
                        (bone == 0 || rig.reference[bone].head == rig.reference[bone - 1].tail);
    if (!linked || rig.reference[bone].head == rig.reference[bone].tail)
      throw InputError(
          who + ": bone " + std::to_string(bone) +
          " does not continue the bone before it; the effect needs a shape whose bones form a chain");
  }
  if (rig.parent.size() < 2) throw InputError(who + ": needs a chain of at least two bones");
}

void read_joints(const SceneState& state, std::vector<Vec3>& joints) {
  joints.resize(state.bones.size() + 1);
  joints[0] = state.bones[0].head;
  for (std::size_t bone = 0; bone < state.bones.size(); ++bone) joints[bone + 1] = state.bones[bone].tail;
}

void pose_chain(const std::vector<Vec3>& joints, SceneState& state) {
  const std::size_t steady = state.steady_bone, count = state.bones.size();
  const Vec3 steady_before = direction(state.bones[steady]);
  for (std::size_t bone = 0; bone < count; ++bone) state.bones[bone] = {joints[bone], joints[bone + 1]};
  state.rotations[steady] =
      composed(smallest_rotation(steady_before, direction(state.bones[steady])), state.rotations[steady]);
  const auto follow = [&](std::size_t bone, std::size_t neighbour) {
    const Vec3 carried = rotated(state.rotations[neighbour], direction(state.shape.rig.reference[bone]));
    state.rotations[bone] =
        composed(smallest_rotation(carried, direction(state.bones[bone])), state.rotations[neighbour]);
  };
  for (std::size_t bone = steady + 1; bone < count; ++bone) follow(bone, bone - 1);
  for (std::size_t bone = steady; bone-- > 0;) follow(bone, bone + 1);
}

}  // namespace cscd::scenes
