#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/mesh/rig.h"
#include "core/radial/atomic_clusters.h"

namespace cscd::fast {

inline constexpr std::int32_t kNone = -1;

// One partition of the triangles into clusters, each seen from the mean of some vertices of the mesh. No cluster
// spans two components (trap 3).
struct Cover {
  std::vector<std::int32_t> cluster_of;           // of each triangle
  std::vector<std::vector<VertexId>> viewed_from;  // of each cluster
};

// Covers that overlap, so that what lies at a seam of one lies well inside a cluster of another.
inline constexpr std::size_t kCovers = 2;
using Covers = std::array<Cover, kCovers>;

// The first cover: the atomic clusters. The second: every triangle with the nearest seam between two of them.
Covers make_covers(const TriangleMesh& mesh, std::span<const Vec3> reference,
                   const radial::AtomicClusters& atomic);

}  // namespace cscd::fast
