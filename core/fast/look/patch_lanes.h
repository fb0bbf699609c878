#pragma once

#include <span>

#include "core/fast/cut/patches.h"
#include "core/fast/look/viewpoint.h"
#include "core/geometry/triple_product16.h"

// What is computed of one patch at a time, all of its vertices and triangles side by side.
namespace cscd::fast {

// The vertices of a patch.
using PatchLanes = VectorLanes16;
PatchLanes load(std::span<const LocalPositions::Record> records,
                const std::array<std::int32_t, kLanes16>& vertex);

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
