#pragma once

#include "core/detect/strategy.h"

namespace cscd {

// Parameters of the paper, with its values.
struct DrvbcOptions {
  double gamma = 0.05;        // merge while fewer than this share of a candidate's triangles is not positive
  double theta_degrees = 10;  // rotation trial of the choice of observers
  int coarsening = 4;         // cells of the distance field, in mean edges (the paper gives none)
  int smoothing_passes = 5;   // over the mesh, before the field (the paper gives none)
  bool relative_boxes = true;
};

// Dynamic radial view based culling, the paper's method. Needs a closed, consistently oriented mesh and a
// rig.
Prepared make_drvbc(const Setup& setup, const DrvbcOptions& options = {});

}  // namespace cscd
