#pragma once

#include <vector>

#include "core/base/vec3.h"
#include "core/mesh/triangle_mesh.h"

namespace cscd::scenes {

// Two triangles, at positions that only exact texts give back.
inline const std::vector<Vec3> kPositions = {
    {0, 0.1, -1e-300}, {1.0 / 3, 2e10, 3}, {-1, -2, -3.5}, {7, 8, 9}};
inline const std::vector<Triangle> kTriangles = {{VertexId{0}, VertexId{1}, VertexId{2}},
                                                 {VertexId{0}, VertexId{2}, VertexId{3}}};

}  // namespace cscd::scenes
