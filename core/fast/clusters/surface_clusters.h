#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/mesh/triangle_mesh.h"

namespace cscd::fast {

// Returns the cluster of each triangle, [triangles], for a mesh without bones, from the surface in the
// reference pose alone. A cluster belongs to one connected component (rule component, core/soundness.md). It
// is about as large as one point sees from behind at angles that are not too flat, so that the point goes on
// seeing it while the surface bends. The number of clusters follows from the shape. Limbs of a closed and
// oriented surface are cut into slabs (limbs.h). One triangle of the mesh stands for `fineness` triangles of
// the surface that will be cut into patches.
std::vector<std::int32_t> surface_clusters(const TriangleMesh& mesh, std::span<const Vec3> reference,
                                           double fineness = 1);

}  // namespace cscd::fast
