#pragma once

#include <string>

#include "core/detect/strategy.h"

namespace cscd::radial {

// Throws InputError, which names what is missing, unless the mesh is closed and consistently oriented and
// there are bones.
void require_radial_setup(const StrategyInput& setup, const std::string& strategy);

}  // namespace cscd::radial
