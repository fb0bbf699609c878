#include "core/fast/prepare/rings.h"

#include "core/base/numbers.h"
#include "core/mesh/adjacency.h"

namespace cscd::fast {

Rings rings_from(const TriangleMesh& mesh, const std::vector<std::vector<TriangleId>>& seeds,
                 std::int32_t most) {
  Rings rings{std::vector<std::int32_t>(mesh.triangle_count(), kNone),
              std::vector<std::int32_t>(mesh.triangle_count(), kNone)};
  std::vector<TriangleId> queue;
  for (std::size_t s = 0; s < seeds.size(); ++s)
    for (const TriangleId t : seeds[s]) {
      if (rings.seed[+t] != kNone) continue;
      rings.seed[+t] = static_cast<std::int32_t>(s);
      rings.distance[+t] = 0;
      queue.push_back(t);
    }
  for (std::size_t next = 0; next < queue.size(); ++next) {
    const TriangleId t = queue[next];
    if (rings.distance[+t] == most) break;
    for_each_neighbour(mesh, t, [&](TriangleId other) {
      if (rings.seed[+other] != kNone) return;
      rings.seed[+other] = rings.seed[+t];
      rings.distance[+other] = rings.distance[+t] + 1;
      queue.push_back(other);
    });
  }
  return rings;
}

}  // namespace cscd::fast
