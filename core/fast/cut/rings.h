#pragma once

#include <cstdint>
#include <vector>

#include "core/mesh/triangle_mesh.h"

namespace cscd::fast {

// The distance of each triangle from the nearest seed in rings of triangles, and which seed that is; kNone
// where no seed is reached.
struct Rings {
  std::vector<std::int32_t> seed, distance;
};

// Grows at most `most` rings of triangles from several sets of seeds at once, breadth first. A ring has the
// triangles that share a vertex with the ring before.
Rings rings_from(const TriangleMesh& mesh, const std::vector<std::vector<TriangleId>>& seeds,
                 std::int32_t most);

}  // namespace cscd::fast
