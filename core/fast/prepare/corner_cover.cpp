#include "core/fast/prepare/corner_cover.h"

#include <algorithm>

namespace cscd::fast {
namespace {

constexpr std::int32_t kCornerRings = 2;  // rings of patches about those that the first two covers miss

}  // namespace

std::vector<std::int32_t> corner_clusters(const TriangleMesh& mesh, const PatchTree& tree) {
  const auto missed = [&](std::size_t p) {
    return (tree.inside[p][0] | tree.inside[p][1]) != tree.patches[p].lanes;
  };
  const auto for_each_touching = [&](std::size_t p, const auto& take) {
    tree.for_each_adjacent(p, [&](std::size_t other, const SharedVertices&) { take(other); });
  };
  std::vector<std::int32_t> cluster(tree.patches.size(), kNone), ring(tree.patches.size(), 0);
  std::vector<std::size_t> queue;
  std::int32_t count = 0;
  for (std::size_t seed = 0; seed < cluster.size(); ++seed) {
    if (cluster[seed] != kNone || !missed(seed)) continue;
    std::size_t next = queue.size();
    cluster[seed] = count;
    queue.push_back(seed);
    for (; next < queue.size(); ++next)
      for_each_touching(queue[next], [&](std::size_t other) {
        if (cluster[other] != kNone || !missed(other)) return;
        cluster[other] = count;
        queue.push_back(other);
      });
    ++count;
  }
  for (std::size_t next = 0; next < queue.size(); ++next) {
    const std::size_t p = queue[next];
    if (ring[p] == kCornerRings) continue;
    for_each_touching(p, [&](std::size_t other) {
      if (cluster[other] != kNone) return;
      cluster[other] = cluster[p];
      ring[other] = ring[p] + 1;
      queue.push_back(other);
    });
  }
  std::vector<std::int32_t> cluster_of(mesh.triangle_count(), kNone);
  for (std::size_t p = 0; p < cluster.size(); ++p)
    for (const TriangleId t : tree.triangles_of(p)) cluster_of[+t] = cluster[p];
  return cluster_of;
}

}  // namespace cscd::fast
