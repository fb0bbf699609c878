#pragma once

#include <span>

#include "core/fast/classify/viewpoint.h"
#include "core/fast/prepare/patches.h"
#include "core/geometry/triple_product16.h"

// Everything that is computed for one patch at a time, with all its vertices and triangles side by side.
namespace cscd::fast {

// The positions of a patch's vertices, one vertex a lane.
using PatchLanes = VectorLanes16;
// Loads the positions of these sixteen vertices.
PatchLanes load(std::span<const LocalPositions::Record> records,
                const std::array<std::int32_t, kLanes16>& vertex);

// The triangles of a patch, one a bit, that are certainly positive at every t, and those that are certainly
// negative at every t.
struct Signs {
  Mask16 positive, negative;
};

// Certifies the signs of a patch's triangles towards a viewpoint. `error` bounds the error of every
// coordinate but the viewpoint's (rule error-bound, core/soundness.md).
Signs orientation(const PatchLanes& lanes, const Patch& patch, const Viewpoint& viewpoint, float error);
// Certifies the signs towards several viewpoints in one go. A null viewpoint gives no signs.
void orientations(const PatchLanes& lanes, const Patch& patch, const Viewpoint* const (&from)[kCovers],
                  float error, Signs (&out)[kCovers]);

// Signs of triangles whose planes keep their distance from the viewpoint, and which of them are tall.
struct DistantSigns {
  Signs signs[kCovers];
  // Positive triangles that are *tall*: all their heights, as seen from the viewpoint, exceed a height
  // ("Theorem: clear stars keep their distance", core/soundness.md).
  Mask16 tall[kCovers];
};
// Certifies, at every t, signs of triangles whose planes are farther than `margin` from the viewpoint, and
// heights above `height`. Both lengths are in local units, and `margin` is the smaller one.
void orientations_at_distance(const PatchLanes& lanes, const Patch& patch,
                              const Viewpoint* const (&from)[kCovers], float error, float margin,
                              float height, DistantSigns& out);

}  // namespace cscd::fast
