#pragma once

#include <array>

#include "core/base/vec3.h"

namespace cscd {

using TriangleCorners = std::array<Vec3, 3>;

// Returns the smallest distance between two closed triangles, to within rounding; 0 if they cross. Either may
// be degenerate. The distance is a measure in plain floating point and proves nothing.
double triangle_distance(const TriangleCorners& a, const TriangleCorners& b);

}  // namespace cscd
