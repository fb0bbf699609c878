#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "core/base/vec3.h"

namespace cscd::scenes {

// Cuts a polygon, seen along `normal`, into triangles by cutting off one corner after the other ("ears"). The
// polygon may touch itself in corners and along edges, as a polygon round a hole does. Each triangle names
// three points in the order in which they lie along the loop. Empty where the polygon overlaps itself, or has
// too many corners for a method whose time is the cube of their number.
std::vector<std::array<std::size_t, 3>> clipped_ears(std::span<const Vec3> loop, const Vec3& normal);

}  // namespace cscd::scenes
