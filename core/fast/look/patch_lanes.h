#pragma once

#include <span>

#include "core/fast/cut/patches.h"
#include "core/fast/look/viewpoint.h"
#include "core/geometry/triple_product16.h"

// The arithmetic of one patch: all of its vertices, or all of its triangles, side by side in vector
// registers.
namespace cscd::fast {

// The positions of a patch's vertices, [end of the interval][axis][place].
using PatchLanes = VectorLanes16;
// Loads the positions of these sixteen vertices.
PatchLanes load(std::span<const LocalPositions::Record> records,
                const std::array<std::int32_t, kLanes16>& vertex);

// The triangles of a patch that are certainly positive at every t, and those that are certainly negative at
// every t (core/radial/orientation.h). The signs are certified (rule error-bound, core/soundness.md).
struct Signs {
  Mask16 positive, negative;
};

// Returns the signs of the triangles of a patch towards a viewpoint. `error` is the error of the positions
// (local_positions.h).
Signs orientation(const PatchLanes& lanes, const Patch& patch, const Viewpoint& viewpoint, float error);
// Returns the signs of the triangles of a patch towards one viewpoint a cover. A null viewpoint gives no
// signs. Computes the normals of the triangles once for all viewpoints.
void orientations(const PatchLanes& lanes, const Patch& patch, const Viewpoint* const (&from)[kCovers],
                  float error, Signs (&out)[kCovers]);

}  // namespace cscd::fast
