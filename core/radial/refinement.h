#pragma once

#include <span>
#include <vector>

#include "core/radial/atomic_clusters.h"
#include "core/radial/bone_observer.h"

namespace cscd::radial {

// Refines clusters by orientation (section 4.1 of the 2014 paper) and returns the bone of each triangle,
// [triangles]. Triangles that are not positive towards their cluster's observer in the reference pose leave
// their cluster. Clusters then grow again over edges, among triangles that are positive towards them. Each
// triangle that is left after that goes to the cluster that reaches it first. Clusters grow breadth first,
// all at once, from their triangles in index order. Takes time O(triangles).
std::vector<BoneId> refine_by_orientation(const TriangleMesh& mesh, std::span<const Vec3> reference,
                                          const Rig& rig, const AtomicClusters& clusters,
                                          std::span<const ObserverKind> kinds);

}  // namespace cscd::radial
