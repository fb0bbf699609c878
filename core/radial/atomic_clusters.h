#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/ids.h"
#include "core/mesh/triangle_mesh.h"

namespace cscd::radial {

// A partition of the triangles. No cluster spans two components of the mesh: along a ray the orientations
// alternate for one connected surface only (rule component).
struct AtomicClusters {
  struct Cluster {
    BoneId bone;
    std::vector<TriangleId> triangles;  // ascending; never empty
  };
  std::vector<std::int32_t> of_triangle;              // index into clusters
  std::vector<Cluster> clusters;                      // ascending by bone, then component
  std::vector<std::vector<std::int32_t>> neighbours;  // clusters that share a mesh edge, ascending; symmetric
};

// Makes one cluster for every bone and component that have triangles in common. `bone_of` gives one valid
// bone for each triangle.
AtomicClusters make_atomic_clusters(const TriangleMesh& mesh, std::span<const BoneId> bone_of_triangle);

}  // namespace cscd::radial
