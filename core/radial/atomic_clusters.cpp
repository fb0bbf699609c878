#include "core/radial/atomic_clusters.h"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <utility>

#include "core/base/sort_unique.h"

// The triangles of one bone form an atomic cluster (Wong et al., I3D 2014, section 4.1). Here the triangles
// of a bone are also split by the connected components of the mesh, because the paper assumes a single
// component. Grouping n triangles takes time n log n.

namespace cscd::radial {

namespace {

void find_neighbours(const TriangleMesh& mesh, AtomicClusters& atomic) {
  std::vector<std::pair<std::int32_t, std::int32_t>> pairs;
  std::vector<std::int32_t> around;
  for (std::size_t e = 0; e < mesh.edge_count(); ++e) {
    around.clear();
    for (const TriangleId t : mesh.triangles_at(EdgeId{static_cast<std::int32_t>(e)}))
      around.push_back(atomic.of_triangle[+t]);
    sort_unique(around);
    for (const std::int32_t a : around)
      for (const std::int32_t b : around)
        if (a != b) pairs.emplace_back(a, b);
  }
  sort_unique(pairs);
  atomic.neighbours.assign(atomic.clusters.size(), {});
  for (const auto& [a, b] : pairs) atomic.neighbours[static_cast<std::size_t>(a)].push_back(b);
}

}  // namespace

AtomicClusters make_atomic_clusters(const TriangleMesh& mesh, std::span<const BoneId> bone_of_triangle) {
  assert(bone_of_triangle.size() == mesh.triangle_count());
  using Key = std::pair<BoneId, std::int32_t>;  // bone, component
  const auto key = [&](std::size_t t) {
    return Key{bone_of_triangle[t], mesh.component(TriangleId{static_cast<std::int32_t>(t)})};
  };
  std::vector<Key> keys;
  keys.reserve(mesh.triangle_count());
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) keys.push_back(key(t));
  sort_unique(keys);

  std::vector<BoneId> bones;
  for (const Key& k : keys) bones.push_back(k.first);
  std::vector<std::int32_t> of_triangle;
  of_triangle.reserve(mesh.triangle_count());
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t)
    of_triangle.push_back(
        static_cast<std::int32_t>(std::lower_bound(keys.begin(), keys.end(), key(t)) - keys.begin()));
  return clusters_of_partition(mesh, std::move(of_triangle), bones);
}

AtomicClusters clusters_of_partition(const TriangleMesh& mesh, std::vector<std::int32_t> of_triangle,
                                     std::span<const BoneId> bones) {
  AtomicClusters atomic;
  for (const BoneId bone : bones) atomic.clusters.push_back({bone, {}});
  atomic.of_triangle = std::move(of_triangle);
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t)
    atomic.clusters[static_cast<std::size_t>(atomic.of_triangle[t])].triangles.push_back(
        TriangleId{static_cast<std::int32_t>(t)});
  find_neighbours(mesh, atomic);
  return atomic;
}

}  // namespace cscd::radial
