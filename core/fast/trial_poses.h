#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "core/mesh/rig.h"
#include "core/mesh/triangle_mesh.h"

namespace cscd::fast {

// Positions at both ends of an interval.
using Trial = std::array<std::vector<Vec3>, 2>;

// What the surface might do: every bone turned about its joint by some 30 degrees about an axis drawn at
// random, and 5 more by the end of the interval. The surface follows the bone of each triangle, smoothed over
// the seams. Poses to count work in; they may meet themselves.
std::vector<Trial> trial_poses(const TriangleMesh& mesh, std::span<const Vec3> reference, const Rig& rig,
                               std::span<const BoneId> bone_of, std::size_t count);

}  // namespace cscd::fast
