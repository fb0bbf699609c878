#pragma once

#include <array>

#include "core/base/vec3.h"

namespace cscd {

using TriangleCorners = std::array<Vec3, 3>;

// Smallest distance of two closed triangles, to within rounding; 0 where they cross. Either may be
// degenerate. Plain floating point: a measure, not a proof.
double triangle_distance(const TriangleCorners& a, const TriangleCorners& b);

}  // namespace cscd
