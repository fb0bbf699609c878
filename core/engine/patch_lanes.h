#pragma once

#include <span>

#include "core/engine/local_positions.h"
#include "core/engine/patches.h"
#include "core/geometry/triple_product16.h"

// What is computed of one patch at a time, all of its vertices and triangles side by side.
namespace cscd::fast {

// The vertices of a patch.
using PatchLanes = VectorLanes16;
PatchLanes load(std::span<const LocalPositions::Record> records,
                const std::array<std::int32_t, kLanes16>& vertex);

// Directions of the bounds: x, y, z, x+y, x+z, y+z, x-y, x-z, those of Kdop16.
inline constexpr std::size_t kDirections = 8;
// How far points lie along them.
template <class Lanes>
inline void along_directions(const Lanes (&p)[3], Lanes (&out)[kDirections]) {
  out[0] = p[0], out[1] = p[1], out[2] = p[2];
  out[3] = p[0] + p[1], out[4] = p[0] + p[2], out[5] = p[1] + p[2];
  out[6] = p[0] - p[1], out[7] = p[0] - p[2];
}

// Bounds of moving points that are valid at every t when interpolated between both ends ("time-linear"): for
// each end, the least projection along every direction, then the greatest.
struct MovingBounds {
  Float16 at[2];
};

// Bounds of the triangles of a patch: [direction][end].
struct TriangleBounds {
  Float16 low[kDirections][2], high[kDirections][2];
};
// `error`: of every coordinate.
TriangleBounds triangle_bounds(const PatchLanes& lanes, const Patch& patch, float error);

// Which of the triangles in `mask` are not proven apart from the bounds, or from triangle `lane` of another
// patch.
Mask16 near(const TriangleBounds& triangles, Mask16 mask, const MovingBounds& other);
Mask16 near(const TriangleBounds& triangles, Mask16 mask, const TriangleBounds& others, std::size_t lane);

// Triangles that certainly are positive, and that certainly are negative, at every t.
struct Signs {
  Mask16 positive, negative;
};

// Of the triangles of a patch.
Signs orientation(const PatchLanes& lanes, const Patch& patch, const Viewpoint& viewpoint, float error);
// The same towards several viewpoints, in one go; null gives none.
void orientations(const PatchLanes& lanes, const Patch& patch, const Viewpoint* const (&from)[kCovers],
                  float error, Signs (&out)[kCovers]);

}  // namespace cscd::fast
