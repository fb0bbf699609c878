#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/vec3.h"

namespace cscd::scenes::fbx {

// Adds the triangles of a polygon to `triangles`. The polygon may be concave and need not be flat. A
// quadrilateral is cut along a diagonal that lies inside, and along the shorter one where both do. Returns
// false if there is no good way to cut the polygon.
bool triangulate(std::span<const std::int32_t> corners, std::span<const Vec3> positions,
                 std::vector<std::array<std::int32_t, 3>>& triangles);

}  // namespace cscd::scenes::fbx
