#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/vec3.h"
#include "core/mesh/rig.h"
#include "core/mesh/triangle_mesh.h"

namespace cscd::radial {

// Returns the positions, [vertices], after moving every vertex half-way to the mean of its neighbours,
// `passes` times, all vertices at once (umbrella operator; Taubin, "A Signal Processing Approach to Fair
// Surface Design", SIGGRAPH 1995, section 2). The step is half-way, because full steps make two-coloured
// meshes flip back and forth. Convex parts shrink. Takes time linear in passes x edges.
std::vector<Vec3> smoothed(const TriangleMesh& mesh, std::span<const Vec3> positions, int passes);

// The resolution at which heat is diffused. The 2013 method works at full resolution. The 2014 paper smooths
// the mesh and coarsens the distance field (section 4.1).
struct HeatOptions {
  int grid_resolution;   // cells along the longest side of the mesh's box
  int smoothing_passes;  // passes of the umbrella operator over the mesh (smoothed); 0 for none
};

// Returns for each triangle the bone that heats it most, [triangles]: the bone whose heat weight
// (heat_weights.h), summed over the three corners, is largest. On a tie, returns the bone with the smaller
// index. The dense table of all weights, [vertices][bones], is never stored. Throws InputError if there is no
// bone, or if the positions are not finite or are too far apart for double precision.
std::vector<BoneId> nearest_bone_by_heat(const TriangleMesh& mesh, std::span<const Vec3> reference,
                                         const Rig& rig, const HeatOptions& options);

}  // namespace cscd::radial
