#pragma once

#include <span>
#include <vector>

#include "core/radial/atomic_clusters.h"
#include "core/radial/observer.h"

namespace cscd::radial {

// Refinement by orientation (section 4.1 of the 2014 paper): triangles that are not positive towards their
// cluster's observer in the reference pose are given up, clusters grow again over edges among triangles that
// are positive towards them, and what is then left goes to whichever cluster reaches it first. Returns the
// bone of each triangle. Breadth-first from all clusters at once, in index order; O(triangles).
std::vector<BoneId> refine_by_orientation(const TriangleMesh& mesh, std::span<const Vec3> reference,
                                          const Rig& rig, const AtomicClusters& clusters,
                                          std::span<const ObserverKind> kinds);

}  // namespace cscd::radial
