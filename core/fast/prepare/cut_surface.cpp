#include "core/fast/prepare/cut_surface.h"

#include <algorithm>
#include <map>

namespace cscd::fast {

namespace {

constexpr std::int32_t kCornerRings = 2;  // rings of patches about those that the first two covers miss

// Gives all triangles of a patch the cluster that most of its triangles have.
std::vector<std::int32_t> rounded_to_patches(const PatchTree& tree, std::vector<std::int32_t> cluster_of) {
  for (std::size_t p = 0; p < tree.patches.size(); ++p) {
    std::map<std::int32_t, int> times;
    for (const TriangleId t : tree.triangles_of(p)) ++times[cluster_of[+t]];
    const auto most = std::max_element(times.begin(), times.end(),
                                       [](const auto& a, const auto& b) { return a.second < b.second; });
    for (const TriangleId t : tree.triangles_of(p)) cluster_of[+t] = most->first;
  }
  return cluster_of;
}

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

void enter_cover(const TriangleMesh& mesh, const Cover& cover, std::size_t number, PatchTree& tree) {
  const std::vector<bool> is_inside = inside(mesh, cover.cluster_of);
  for (std::size_t p = 0; p < tree.patches.size(); ++p) {
    const std::span<const TriangleId> triangles = tree.triangles_of(p);
    tree.patches[p].cluster[number] = cover.cluster_of[+triangles[0]];
    for (std::size_t l = 0; l < triangles.size(); ++l)
      tree.inside[p][number] |= static_cast<Mask16>(is_inside[+triangles[l]] << l);
  }
}

CutSurface cut_surface(const TriangleMesh& mesh, std::span<const Vec3> reference,
                       std::span<const std::int32_t> cluster_of, std::size_t least_cell,
                       const ThreadPool& pool) {
  CutSurface cut;
  auto& [covers, tree] = cut;
  std::vector<std::int32_t> parts(cluster_of.begin(), cluster_of.end());
  merge_thin_clusters(mesh, parts);
  covers[0] = make_cover(mesh, reference, std::move(parts), pool);
  std::vector<std::int32_t> seams = nearest_seams(mesh, covers[0].cluster_of);
  tree = make_tree(mesh, reference,
                   cut_into_patches(mesh, reference, {covers[0].cluster_of, seams}, least_cell, pool),
                   covers[0].cluster_of);
  enter_cover(mesh, covers[0], 0, tree);
  covers[1] = make_cover(mesh, reference, rounded_to_patches(tree, std::move(seams)), pool);
  enter_cover(mesh, covers[1], 1, tree);
  covers[2] = make_cover(mesh, reference, corner_clusters(mesh, tree), pool);
  enter_cover(mesh, covers[2], 2, tree);
  return cut;
}

}  // namespace cscd::fast
