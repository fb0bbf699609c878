#pragma once

#include <cstdint>
#include <span>

#include "core/fast/cut/covers.h"
#include "core/fast/cut/patches.h"

namespace cscd::fast {

// A surface as `drvbc_fast` prepares it: cut into patches, with three covers to look at the patches from.
//   covers[0]  the given clusters, thin ones merged
//   covers[1]  for each seam between two of those clusters, the patches that are nearer to it than to other
//   seams covers[2]  the places where seams of both meet, and their surroundings
// Every patch lies in one cluster of each cover or in none.
struct CutSurface {
  Covers covers;
  PatchTree tree;
};

// The number of triangles that a seam of the second cover has to cut out of a cluster of the first; otherwise
// the seam gives way to whole patches. A larger number makes fewer patches, but leaves more of them in no
// cluster of the second cover.
inline constexpr std::size_t kLeastCell = 40;

// Cuts a surface along the clusters of its triangles, [triangles] labels, each of one connected component:
// the clusters of bones (core/radial/atomic_clusters.h) or of the surface alone (surface_clusters.h). The
// observers are placed in the reference pose.
CutSurface cut_surface(const TriangleMesh& mesh, std::span<const Vec3> reference,
                       std::span<const std::int32_t> cluster_of, std::size_t least_cell = kLeastCell);

}  // namespace cscd::fast
