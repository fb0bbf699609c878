#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/ids.h"
#include "core/base/vec3.h"
#include "core/crossing/curves.h"
#include "core/mesh/triangle_mesh.h"

namespace cscd {

// What images of curves (CrossingRegion) cut off one sheet, with the vertices there.
struct CutOffPart {
  std::span<const std::int32_t> images;
  std::span<const VertexId> vertices;
  const std::vector<std::uint8_t>& is_cut;       // [triangles], whether a curve runs through
  const std::vector<std::uint8_t>& is_on_curve;  // [vertices], whether a curve ends there
};

// How far a point of the part can be from all its vertices and all points of its curves.
double reach(const TriangleMesh& mesh, std::span<const Vec3> positions, const CrossingCurves& all,
             const CutOffPart& part);

}  // namespace cscd
