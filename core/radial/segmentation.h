#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/vec3.h"
#include "core/mesh/rig.h"
#include "core/mesh/triangle_mesh.h"

namespace cscd::radial {

// How much care the diffusion takes: the 2013 method works at full resolution, the 2014 paper smooths the
// mesh and coarsens the distance field (section 4.1).
struct HeatOptions {
  int grid_resolution;   // cells along the longest side of the mesh's box
  int smoothing_passes;  // umbrella-operator passes over the mesh beforehand; 0 for none
};

// Bone-heat weights: one row a vertex, one column a bone would be dense; only the bone with the largest
// weight is needed, so this returns, per triangle, the bone whose weight summed over the three corners is
// largest (ties: the smaller index).
std::vector<BoneId> nearest_bone_by_heat(const TriangleMesh& mesh, std::span<const Vec3> reference,
                                         const Rig& rig, const HeatOptions& options);

}  // namespace cscd::radial
