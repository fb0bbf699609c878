#pragma once

#include <cstdint>
#include <span>

#include "core/mesh/rig.h"
#include "core/mesh/triangle_mesh.h"

namespace cscd::fast {

// Returns a skeleton for a surface of which only the parts are known: one bone for each part, whose joint is
// the middle of the seam to its parent. `part_of` is [triangles], at least one; parts are numbered from 0
// without gaps. A part hangs on the neighbour with which it shares the longest seam, counted in edges,
// beginning at the part of most triangles of each connected component.
Rig joints_of_parts(const TriangleMesh& mesh, std::span<const Vec3> reference,
                    std::span<const std::int32_t> part_of);

}  // namespace cscd::fast
