#pragma once

#include <span>

#include "core/base/vec3.h"
#include "core/mesh/triangle_mesh.h"

namespace cscd {

// The mean length of the edges in a pose, [vertices]; 0 without edges.
inline double mean_edge(const TriangleMesh& mesh, std::span<const Vec3> pose) {
  double sum = 0;
  for (const auto& [p, q] : mesh.edges())
    sum += (pose[+p] - pose[+q]).norm() / static_cast<double>(mesh.edge_count());
  return sum;
}

}  // namespace cscd
