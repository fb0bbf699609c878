#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/engine/following_point.h"
#include "core/mesh/triangle_mesh.h"

namespace cscd::fast {

inline constexpr std::int32_t kNone = -1;

// Disjoint clusters of triangles, each with its observer. No cluster spans two components (trap 3).
struct Cover {
  std::vector<std::int32_t> cluster_of;  // of each triangle; kNone where the cover has none
  std::vector<FollowingPoint> observers;
};

// Covers that overlap, so that what lies at a seam of one lies well inside a cluster of another:
//   0  the given clusters, thin ones merged
//   1  triangles about a seam between two of them with the nearest one, whole patches at a time
//   2  where seams of both meet: what has all around it in no cluster of theirs, and its surroundings
// The last two are completed with the patches (patches.h): until then the second has the nearest seam of
// single triangles and no observers, the third no cluster.
inline constexpr std::size_t kCovers = 3;
using Covers = std::array<Cover, kCovers>;
// Takes the cluster of each triangle, of one component each: of bones (radial/atomic_clusters.h), or of the
// surface alone (surface_clusters.h).
Covers make_covers(const TriangleMesh& mesh, std::span<const Vec3> reference,
                   std::span<const std::int32_t> cluster_of);

// Numbers the clusters of a cover from 0 and gives each its observer.
void place_observers(const TriangleMesh& mesh, std::span<const Vec3> reference, Cover& cover);

// Triangles all around whose corners belong to their own cluster.
std::vector<bool> inside(const TriangleMesh& mesh, std::span<const std::int32_t> cluster_of);

}  // namespace cscd::fast
