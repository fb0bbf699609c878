#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/fast/prepare/covers.h"
#include "core/fast/prepare/patches.h"

namespace cscd::fast {

// Returns the clusters of the third cover, [triangles], with kNone for a triangle without a cluster. A
// cluster is made of whole patches. It begins as a connected group of patches, each of which holds a triangle
// that lies inside no cluster of the first two covers. It then takes in a few rings of patches round the
// group. `tree.inside` must already say what lies inside the clusters of the first two covers.
std::vector<std::int32_t> corner_clusters(const TriangleMesh& mesh, const PatchTree& tree);

// A surface as `drvbc_fast` prepares it: cut into patches, with three covers to look at the patches from.
//
// covers[0] has the given clusters, with thin ones merged. It holds every triangle.
//
// covers[1] has one cluster for each seam between two clusters of covers[0]: the patches near that seam.
//
// covers[2] has the places where seams of the first two covers meet, and the patches round those places.
//
// In each cover, a patch belongs to one cluster as a whole or to none.
struct CutSurface {
  Covers covers;
  PatchTree tree;
};

// The least number of triangles in a cell (patches.h) that a seam of the second cover cuts out of a cluster
// of the first cover. Where a seam would make a smaller cell, the seam gives way to whole patches. A larger
// number makes fewer patches, but leaves more of them in no cluster of the second cover.
inline constexpr std::size_t kLeastCell = 96;

// Cuts a surface along the seams of its clusters, and makes the three covers. `cluster_of`, [triangles],
// names the cluster of each triangle: clusters of bones (core/radial/atomic_clusters.h) or clusters of the
// surface (surface_clusters.h). Each cluster must lie in one connected component of the mesh. The observers
// are placed in the reference pose, `reference` [vertices]. The threads of the pool share the work; the
// result does not depend on their number.
CutSurface cut_surface(const TriangleMesh& mesh, std::span<const Vec3> reference,
                       std::span<const std::int32_t> cluster_of, std::size_t least_cell = kLeastCell,
                       const ThreadPool& pool = ThreadPool());

// Writes into the tree, for cover `number`, the cluster of each patch and the triangles of each patch that
// lie inside that cluster.
void enter_cover(const TriangleMesh& mesh, const Cover& cover, std::size_t number, PatchTree& tree);

}  // namespace cscd::fast
