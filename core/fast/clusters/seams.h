#pragma once

#include <span>

#include "core/mesh/triangle_mesh.h"

namespace cscd::fast {

// Visits every edge between triangles of different clusters. A seam is the set of such edges between two
// clusters. `cluster_of` is [triangles].
template <class Take>  // (triangle on one side, triangle on the other)
void for_each_seam_edge(const TriangleMesh& mesh, std::span<const std::int32_t> cluster_of,
                        const Take& take) {
  for (std::size_t e = 0; e < mesh.edge_count(); ++e) {
    const std::span<const TriangleId> sides = mesh.triangles_at(EdgeId{static_cast<std::int32_t>(e)});
    if (cluster_of[+sides.front()] != cluster_of[+sides.back()]) take(sides.front(), sides.back());
  }
}

}  // namespace cscd::fast
