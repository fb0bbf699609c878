#pragma once

#include <array>

#include "core/base/vec3.h"

namespace cscd::scenes {

using TriangleCorners = std::array<Vec3, 3>;

// Returns the smallest distance of two closed triangles, to within rounding, and 0 where they cross. The
// triangles may be degenerate. This is a measure in plain floating point, not a proof.
double triangle_distance(const TriangleCorners& a, const TriangleCorners& b);

}  // namespace cscd::scenes
