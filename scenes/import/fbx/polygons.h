#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/vec3.h"

namespace cscd::scenes::fbx {

// Adds the triangles of a polygon, which may be concave and need not be flat. A quadrilateral is cut along
// the shorter one of the diagonals that lie inside. Returns false where there is no good way to cut it.
bool triangulate(std::span<const std::int32_t> corners, std::span<const Vec3> positions,
                 std::vector<std::array<std::int32_t, 3>>& triangles);

}  // namespace cscd::scenes::fbx
