#include "baselines/rvbc.h"

#include "baselines/rvbc_culler.h"
#include "core/base/stage_clock.h"
#include "core/detect/compose.h"
#include "core/radial/distance_field.h"
#include "core/radial/segmentation.h"
#include "core/radial/setup.h"

namespace cscd {

Prepared make_rvbc(const StrategyInput& setup, const RvbcOptions& options) {
  radial::require_radial_setup(setup, std::string(options.name));
  StageClock clock;
  clock.enter(Stage::distance_and_heat);
  const int resolution = radial::resolution_of_mean_edge(setup.mesh, setup.reference);
  const std::vector<BoneId> bone_of =
      radial::nearest_bone_by_heat(setup.mesh, setup.reference, *setup.rig, {resolution, 0});

  clock.enter(Stage::decomposition);
  radial::AtomicClusters clusters = radial::make_atomic_clusters(setup.mesh, bone_of);
  std::vector<radial::ObserverKind> kinds =
      radial::choose_in_reference_pose(setup.mesh, setup.reference, *setup.rig, clusters);
  clock.stop();

  Preparation preparation{clock.milliseconds(Stage::distance_and_heat),
                          clock.milliseconds(Stage::decomposition), clusters.of_triangle,
                          static_cast<int>(clusters.clusters.size())};
  auto culler = std::make_unique<RvbcCuller>(setup, std::move(clusters), std::move(kinds));
  return {compose(std::move(culler), setup, {options.relative_boxes}), preparation};
}

}  // namespace cscd
