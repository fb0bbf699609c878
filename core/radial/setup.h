#pragma once

#include <string>

#include "core/base/error.h"
#include "core/detect/strategy.h"

namespace cscd::radial {

// Throws InputError, which names what is missing, unless the mesh is closed and consistently oriented and
// there are bones.
inline void require_radial_setup(const StrategyInput& setup, const std::string& strategy) {
  require_closed_and_oriented(setup.mesh, "strategy " + strategy);
  if (setup.rig == nullptr || setup.rig->parent.empty())
    throw InputError(
        "strategy " + strategy +
        " needs bones and the input has none; add /bones to the point cache or use a strategy that needs "
        "no rig, such as base");
}

}  // namespace cscd::radial
