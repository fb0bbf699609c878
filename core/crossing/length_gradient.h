#pragma once

#include <span>
#include <utility>
#include <vector>

#include "core/base/ids.h"
#include "core/base/vec3.h"
#include "core/crossing/overlaps.h"
#include "core/mesh/triangle_mesh.h"

namespace cscd {

// The length of the curves of an overlap, and its gradient: how it grows when a vertex moves. Vertices whose
// movement does not change the length are left out. Each curve stays between the same triangles as long as
// the movement is small.
struct CurveLength {
  double length = 0;
  std::vector<std::pair<VertexId, Vec3>> gradient;  // sorted by vertex
};
CurveLength length_gradient(const TriangleMesh& mesh, std::span<const Vec3> positions,
                            const CrossingCurves& all, const Overlap& overlap);

}  // namespace cscd
