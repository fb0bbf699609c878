#pragma once

#include <string_view>

#include "core/detect/strategy.h"

namespace cscd {

struct DrvbcFastOptions {
  std::string_view name = "drvbc_fast";  // begins error texts
  // For the ablation.
  std::size_t covers = 3;  // the first of them
  bool time_linear = true;
  bool stars = true;
  bool bones = true;  // false: as if there were none
};

// Radial view based culling with overlapping covers. Needs a closed, consistently oriented mesh; begins
// from the clusters of bones where there are any, else from clusters of the surface.
Prepared make_drvbc_fast(const Setup& setup, const DrvbcFastOptions& options = {});

}  // namespace cscd
