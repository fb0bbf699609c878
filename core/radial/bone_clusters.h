#pragma once

#include <vector>

#include "core/base/stage_clock.h"
#include "core/detect/strategy.h"
#include "core/mesh/rig.h"

namespace cscd::radial {

// How the 2014 paper assigns triangles to bones (section 4.1), with the paper's values where it gives any.
struct BoneClusterOptions {
  double theta_degrees = 10;  // angle of the rotation trial that chooses observers (observer.h)
  int coarsening = 4;         // length of a cell of the distance field, in mean edges (the paper gives none)
  int smoothing_passes = 5;   // over the mesh, before the distance field is made (the paper gives none)
  bool refinement = true;     // by orientation (refinement.h)

  double theta() const;  // `theta_degrees` in radians
};

// Returns the bone of each triangle, [triangles]: the bone that heats the triangle most, refined by
// orientation. Charges the clock's stage `distance_and_heat`, then `decomposition`, and leaves the clock in
// the latter. Throws InputError if the set-up's rig has no bones, or if its positions are not finite or are
// too far apart.
std::vector<BoneId> bones_of_triangles(const Setup& setup, const BoneClusterOptions& options,
                                       StageClock& clock);

}  // namespace cscd::radial
