#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/ids.h"
#include "core/mesh/triangle_mesh.h"

namespace cscd::radial {

// A partition of the triangles into atomic clusters, the smallest groups that share an observer. No cluster
// spans two connected components of the mesh: along a ray the orientations alternate for one connected
// surface only (rule component, core/soundness.md).
struct AtomicClusters {
  struct Cluster {
    BoneId bone;
    std::vector<TriangleId> triangles;  // ascending; never empty
  };
  std::vector<std::int32_t> of_triangle;              // [triangles]; index into `clusters`
  std::vector<Cluster> clusters;                      // ascending by bone, then component
  std::vector<std::vector<std::int32_t>> neighbours;  // [clusters]; those that share a mesh edge, ascending
};

// Makes one cluster for every bone and component that have triangles in common. `bone_of` gives one valid
// bone for each triangle.
AtomicClusters make_atomic_clusters(const TriangleMesh& mesh, std::span<const BoneId> bone_of_triangle);

// Makes the clusters of a given partition. Every triangle of cluster c of `of_triangle` follows bone
// `bones[c]`, and no cluster may be empty or span two components.
AtomicClusters clusters_of_partition(const TriangleMesh& mesh, std::vector<std::int32_t> of_triangle,
                                     std::span<const BoneId> bones);

}  // namespace cscd::radial
