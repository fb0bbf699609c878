#include "core/radial/bone_clusters.h"

#include <algorithm>
#include <numbers>

#include "core/radial/bone_observer.h"
#include "core/radial/distance_field.h"
#include "core/radial/refinement.h"
#include "core/radial/segmentation.h"

namespace cscd::radial {

double BoneClusterOptions::theta() const {
  return theta_degrees * std::numbers::pi / 180;
}

std::vector<BoneId> bones_of_triangles(const StrategyInput& setup, const BoneClusterOptions& options,
                                       StageClock& clock) {
  clock.enter(Stage::distance_and_heat);
  const int full = resolution_of_mean_edge(setup.mesh, setup.reference);
  std::vector<BoneId> bone_of =
      nearest_bone_by_heat(setup.mesh, setup.reference, *setup.rig,
                           {std::max(1, full / options.coarsening), options.smoothing_passes});
  clock.enter(Stage::decomposition);
  if (!options.refinement) return bone_of;
  const AtomicClusters clusters = make_atomic_clusters(setup.mesh, bone_of);
  const std::vector<ObserverKind> kinds =
      choose_by_rotation_trial(setup.mesh, setup.reference, *setup.rig, clusters, options.theta());
  return refine_by_orientation(setup.mesh, setup.reference, *setup.rig, clusters, kinds);
}

}  // namespace cscd::radial
