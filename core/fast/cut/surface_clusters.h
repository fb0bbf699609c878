#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/mesh/triangle_mesh.h"

namespace cscd::fast {

// The cluster of each triangle, for a mesh without bones: from the surface in the reference pose alone. A
// cluster belongs to one component (rule component) and is about as large as one point sees from behind and not too
// flat, so that it goes on seeing it while the surface bends. How many there are follows from the shape.
std::vector<std::int32_t> surface_clusters(const TriangleMesh& mesh, std::span<const Vec3> reference);

}  // namespace cscd::fast
