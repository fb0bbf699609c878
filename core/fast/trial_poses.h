#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "core/mesh/rig.h"
#include "core/mesh/triangle_mesh.h"

namespace cscd::fast {

// The positions of one interval: [end of the interval][vertices].
using Trial = std::array<std::vector<Vec3>, 2>;

// Makes `count` intervals as an animation might have them, in which the trial counts the work of its
// candidates (trial.h). At the start every bone is turned by 30 degrees about an axis through its joint,
// drawn at random; by the end it has turned by 5 degrees more. Each triangle follows its bone, `bone_of`
// [triangles], and the shifts of the vertices are smoothed over the seams between bones. A surface may cross
// itself in these poses.
std::vector<Trial> trial_poses(const TriangleMesh& mesh, std::span<const Vec3> reference, const Rig& rig,
                               std::span<const BoneId> bone_of, std::size_t count);

}  // namespace cscd::fast
