#pragma once

#include "core/detect/strategy.h"

namespace cscd {

// "MCD" of the paper's section 7.1: normal cone culling (Tang, Curtis, Yoon and Manocha, "ICCD: Interactive
// Continuous Collision Detection between Deformable Models Using Connectivity-Based Culling", TVCG 15(4),
// 2009) and the deforming non-penetration filter.
Prepared make_mcd(const StrategyInput& setup);

}  // namespace cscd
