#pragma once

#include <vector>

#include "core/base/stage_clock.h"
#include "core/detect/strategy.h"
#include "core/mesh/rig.h"

namespace cscd::radial {

// How the 2014 paper gives triangles to bones (section 4.1), with the paper's values where it gives any.
struct BoneClusterOptions {
  double theta_degrees = 10;  // the rotation by which observers are tried
  int coarsening = 4;  // the side of a cell of the distance field, in mean edges (the paper gives no value)
  int smoothing_passes = 5;  // passes over the mesh before the field (the paper gives no value)
  bool refinement = true;    // refine clusters by orientation (refinement.h)

  double theta() const;  // `theta_degrees` in radians
};

// Returns the bone of each triangle, [triangles], by heat and then refined. Leaves the clock in the stage
// `decomposition`.
std::vector<BoneId> bones_of_triangles(const StrategyInput& setup, const BoneClusterOptions& options,
                                       StageClock& clock);

}  // namespace cscd::radial
