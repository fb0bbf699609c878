#pragma once

#include "core/detect/strategy.h"

namespace cscd {

// All pairs of triangles, the oracle for small meshes. Quadratic.
Prepared make_brute(const StrategyInput& setup);

}  // namespace cscd
