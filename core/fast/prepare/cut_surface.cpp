#include "core/fast/prepare/cut_surface.h"

#include <algorithm>
#include <map>

#include "core/fast/prepare/corner_cover.h"

namespace cscd::fast {
namespace {

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
                       std::span<const std::int32_t> cluster_of, std::size_t least_cell, const Team& team) {
  CutSurface cut;
  auto& [covers, tree] = cut;
  std::vector<std::int32_t> parts(cluster_of.begin(), cluster_of.end());
  merge_thin_clusters(mesh, parts);
  covers[0] = make_cover(mesh, reference, std::move(parts), team);
  std::vector<std::int32_t> seams = nearest_seams(mesh, covers[0].cluster_of);
  tree = make_tree(mesh, reference,
                   cut_into_patches(mesh, reference, {covers[0].cluster_of, seams}, least_cell, team),
                   covers[0].cluster_of);
  enter_cover(mesh, covers[0], 0, tree);
  covers[1] = make_cover(mesh, reference, rounded_to_patches(tree, std::move(seams)), team);
  enter_cover(mesh, covers[1], 1, tree);
  covers[2] = make_cover(mesh, reference, corner_clusters(mesh, tree), team);
  enter_cover(mesh, covers[2], 2, tree);
  return cut;
}

}  // namespace cscd::fast
