#pragma once

#include <span>
#include <vector>

#include "core/base/vec3.h"
#include "core/mesh/triangle_mesh.h"

namespace cscd::radial {

// Returns the positions, [vertices], after moving every vertex half-way to the mean of its neighbours,
// `passes` times, all vertices at once (umbrella operator; Taubin, "A Signal Processing Approach to Fair
// Surface Design", SIGGRAPH 1995, section 2). The step is half-way, because full steps make two-coloured
// meshes flip back and forth. Convex parts shrink. Takes time linear in passes x edges.
std::vector<Vec3> smoothed(const TriangleMesh& mesh, std::span<const Vec3> positions, int passes);

}  // namespace cscd::radial
