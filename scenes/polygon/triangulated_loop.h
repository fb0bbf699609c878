#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "core/base/vec3.h"

namespace cscd::scenes {

// What a closed loop of points is: the border of a hole in a surface, or a polygon that is nearly flat.
enum class LoopKind { hole, polygon };

// Cuts a closed loop into triangles (CGAL's triangulate_hole_polyline). Each names three points in the order
// in which they lie along the loop, and so is oriented as the loop is. Empty where there is no good way.
std::vector<std::array<std::size_t, 3>> triangulated_loop(std::span<const Vec3> loop, LoopKind kind);

}  // namespace cscd::scenes
