#pragma once

#include <span>
#include <vector>

#include "core/base/ids.h"
#include "core/base/vec3.h"

namespace cscd {

// A bone in one pose: the segment from its head, the joint about which it turns, to its tail.
struct Bone {
  Vec3 head, tail;
};

// The skeleton of a mesh. `reference` is its pose at frame 0, to which the mesh's reference positions belong.
struct Rig {
  std::vector<BoneId> parent;   // [bones]; BoneId{-1} for a root
  std::vector<Bone> reference;  // [bones]

  // The bones at both ends of one interval, [bones] each. In between, heads and tails move in straight lines.
  struct Interval {
    std::span<const Bone> start, end;
  };
};

// Throws InputError unless all parents are in range and form no cycle, both vectors have one entry a
// bone, and every joint is finite.
void validate(const Rig& rig);

}  // namespace cscd
