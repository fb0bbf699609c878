#pragma once

#include "core/detect/strategy.h"

namespace cscd {

// "AABB" of the paper's section 7.1: a hierarchy of swept axis-aligned boxes (van den Bergen, Journal of
// Graphics Tools 2(4), cited there as 1999).
Prepared make_aabb(const StrategyInput& setup);

}  // namespace cscd
