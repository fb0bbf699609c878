#pragma once

#include "core/detect/strategy.h"

namespace cscd {

// Radial view based culling with fixed clusters (Wong, Lin, Hung, Huang and Lii, ACM TOG 32(4), 2013). Needs
// a closed, consistently oriented mesh and a rig.
Prepared make_rvbc(const Setup& setup);

}  // namespace cscd
