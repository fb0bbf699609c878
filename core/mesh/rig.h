#pragma once

#include <span>
#include <vector>

#include "core/base/ids.h"
#include "core/base/vec3.h"

namespace cscd {

// A bone in one pose: the segment from head (the joint it turns about) to tail.
struct Bone {
  Vec3 head, tail;
};

// The skeleton of a mesh. `reference` is its pose at frame 0, to which the reference positions belong.
struct Rig {
  std::vector<BoneId> parent;  // one a bone; BoneId{-1} for a root
  std::vector<Bone> reference;

  // The bones at both ends of one interval; in between, heads and tails move in straight lines.
  struct Interval {
    std::span<const Bone> start, end;
  };
};

// Throws InputError unless parents are in range and acyclic and every joint is finite.
void validate(const Rig& rig);

}  // namespace cscd
