#pragma once

#include <cstdint>
#include <vector>

#include "core/mesh/triangle_mesh.h"

namespace cscd::fast {

// How far each triangle lies from several sets of triangles, the seeds. A ring has the triangles that share a
// vertex with the ring before.
struct Rings {
  std::vector<std::int32_t> seed;      // [triangles]: which set is nearest; kNone if no ring reaches it
  std::vector<std::int32_t> distance;  // [triangles]: the number of rings from that set, or kNone
};

// Grows at most `most` rings of triangles from all sets of seeds at once, breadth first.
Rings rings_from(const TriangleMesh& mesh, const std::vector<std::vector<TriangleId>>& seeds,
                 std::int32_t most);

}  // namespace cscd::fast
