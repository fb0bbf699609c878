#pragma once

#include <limits>
#include <span>

#include "core/fast/classify/local_positions.h"
#include "core/fast/prepare/following_point.h"
#include "core/fast/prepare/patches.h"
#include "core/geometry/triple_product16.h"

// Everything that is computed for one patch at a time, with all its vertices and triangles side by side.
namespace cscd::fast {

// Where an observer stands at both ends of an interval, [end][axis], in local coordinates; it moves in a
// straight line between the two. A viewpoint is exactly these numbers and has no error. The vertices that are
// seen from it have an error, which the orientations allow for.
struct Viewpoint {
  float at[2][3];
  // More than the distance of any vertex from the viewpoint along an axis, including the error of the vertex.
  // Infinite until reach_of() has computed it.
  float reach = std::numeric_limits<float>::infinity();
};

// Returns the `reach` of a viewpoint among vertices whose coordinates are off by at most `error`, which must
// be at least 2^-24 of the largest coordinate.
float reach_of(const Viewpoint& viewpoint, float error);

// Returns the viewpoint of an observer that follows the vertices with these records (local_positions.h).
Viewpoint placed(const FollowingPoint& point, std::span<const LocalPositions::Record> records);

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
  // ("Theorem: clear one-rings keep their distance", core/soundness.md).
  Mask16 tall[kCovers];
};
// Certifies, at every t, signs of triangles whose planes are farther than `margin` from the viewpoint, and
// heights above `height`. Both lengths are in local units, and `margin` is the smaller one.
void orientations_at_distance(const PatchLanes& lanes, const Patch& patch,
                              const Viewpoint* const (&from)[kCovers], float error, float margin,
                              float height, DistantSigns& out);

}  // namespace cscd::fast
