#pragma once

#include <vector>

#include "core/base/stage_clock.h"
#include "core/detect/strategy.h"
#include "core/mesh/rig.h"

namespace cscd::radial {

// How the 2014 paper gives triangles to bones (section 4.1), with its values where it gives any.
struct BoneClusterOptions {
  double theta_degrees = 10;  // rotation trial of the choice of observers
  int coarsening = 4;         // cells of the distance field, in mean edges (the paper gives none)
  int smoothing_passes = 5;   // over the mesh, before the field (the paper gives none)
  bool refinement = true;     // by orientation

  double theta() const;  // in radians
};

// The bone of each triangle: by heat, then refined. Leaves the clock in the stage `decomposition`.
std::vector<BoneId> bones_of_triangles(const Setup& setup, const BoneClusterOptions& options,
                                       StageClock& clock);

}  // namespace cscd::radial
