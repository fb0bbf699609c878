#pragma once

#include "core/detect/strategy.h"

namespace cscd {

// "Base" of the paper's section 7.1: a plain hierarchy of swept 16-DOPs, split at the
// median (Klosowski et al. 1998).
Prepared make_base(const StrategyInput& setup);

}  // namespace cscd
