#pragma once

#include <string_view>

#include "core/detect/strategy.h"

namespace cscd {

struct RvbcOptions {
  std::string_view name = "rvbc";  // begins error texts
  bool relative_boxes = false;     // the 2014 paper's addition
};

// Radial view based culling with fixed clusters (Wong, Lin, Hung, Huang and Lii, ACM TOG 32(4), 2013). Throws
// InputError unless the setup has a closed, consistently oriented mesh and a rig.
Prepared make_rvbc(const StrategyInput& setup, const RvbcOptions& options = {});

}  // namespace cscd
