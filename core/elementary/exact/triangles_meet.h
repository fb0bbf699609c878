#pragma once

#include <span>

#include "core/base/vec3.h"
#include "core/mesh/triangle_mesh.h"

namespace cscd {

// Whether two different triangles of a mesh meet in these positions, [vertices], except in the vertices and
// edges they share. Exact.
bool triangles_meet(const TriangleMesh& mesh, std::span<const Vec3> positions, TriangleId a, TriangleId b);

}  // namespace cscd
