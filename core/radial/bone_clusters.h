#pragma once

#include <span>
#include <vector>

#include "core/base/stage_clock.h"
#include "core/detect/strategy.h"
#include "core/mesh/rig.h"
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

// How the 2014 paper gives triangles to bones (section 4.1), with the paper's values where it gives any.
struct BoneClusterOptions {
  double theta_degrees = 10;  // the rotation by which observers are tried
  int coarsening = 4;  // the side of a cell of the distance field, in mean edges (the paper gives no value)
  int smoothing_passes = 5;  // passes over the mesh before the field (the paper gives no value)
  bool refinement = true;    // refine clusters by orientation

  double theta() const;  // `theta_degrees` in radians
};

// Returns the bone of each triangle, [triangles], by heat and then refined. Leaves the clock in the stage
// `decomposition`.
std::vector<BoneId> bones_of_triangles(const StrategyInput& setup, const BoneClusterOptions& options,
                                       StageClock& clock);

}  // namespace cscd::radial
