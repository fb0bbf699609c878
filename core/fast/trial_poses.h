#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "core/mesh/rig.h"
#include "core/mesh/triangle_mesh.h"

namespace cscd::fast {

// Positions at both ends of an interval, [vertices] each.
using PosePair = std::array<std::vector<Vec3>, 2>;

// Returns `count` intervals of what a closed and oriented surface might do, to count work in. Every bone is
// turned about its joint by some 20 degrees about an axis drawn at random, and by 5 degrees more at the end
// of the interval. The surface follows the bone of each triangle, `bone_of` [triangles], smoothed over the
// seams. The poses may cross themselves.
std::vector<PosePair> trial_poses(const TriangleMesh& mesh, std::span<const Vec3> reference, const Rig& rig,
                                  std::span<const BoneId> bone_of, std::size_t count);

}  // namespace cscd::fast
