#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/mesh/triangle_mesh.h"

namespace cscd::fast {

// Returns the cluster of each triangle, [triangles], found from the surface in the reference pose alone, for
// meshes without bones. A cluster belongs to one connected component (rule component, core/soundness.md). A
// cluster is about as large as one point can see well from behind: most of its triangles face away from that
// point steeply enough to keep facing away while the surface bends. The number of clusters follows from the
// shape.
std::vector<std::int32_t> surface_clusters(const TriangleMesh& mesh, std::span<const Vec3> reference);

}  // namespace cscd::fast
