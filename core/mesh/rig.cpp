#include "core/mesh/rig.h"

#include <string>

#include "core/base/error.h"

namespace cscd {

void validate(const Rig& rig) {
  const auto count = static_cast<int>(rig.parent.size());
  if (rig.reference.size() != rig.parent.size())
    throw InputError("rig: " + std::to_string(count) + " parents but " +
                     std::to_string(rig.reference.size()) +
                     " bones in the reference pose; give one of each per bone");
  for (int bone = 0; bone < count; ++bone) {
    const Bone& pose = rig.reference[static_cast<std::size_t>(bone)];
    if (!pose.head.allFinite() || !pose.tail.allFinite())
      throw InputError("rig: bone " + std::to_string(bone) +
                       " has a joint that is not finite; repair the pose");
    int ancestor = bone;
    for (int steps = 0; ancestor != -1; ++steps) {
      const int parent = static_cast<int>(rig.parent[static_cast<std::size_t>(ancestor)]);
      if (parent < -1 || parent >= count)
        throw InputError("rig: bone " + std::to_string(ancestor) + " has parent " + std::to_string(parent) +
                         ", outside [-1, " + std::to_string(count) + "); -1 marks a root");
      if (steps > count)
        throw InputError("rig: bone " + std::to_string(bone) +
                         " is its own ancestor; parents must form a tree");
      ancestor = parent;
    }
  }
}

}  // namespace cscd
