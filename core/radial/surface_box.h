#pragma once

#include <Eigen/Geometry>
#include <span>

#include "core/base/vec3.h"
#include "core/mesh/triangle_mesh.h"

namespace cscd::radial {

// Returns the bounding box of the triangles. Vertices that no triangle uses do not count.
inline Eigen::AlignedBox3d surface_box(const TriangleMesh& mesh, std::span<const Vec3> positions) {
  Eigen::AlignedBox3d box;
  for (const Triangle& t : mesh.triangles())
    for (const VertexId v : t) box.extend(positions[+v]);
  return box;
}

}  // namespace cscd::radial
