#pragma once

#include <string>

#include "core/detect/strategy.h"

namespace cscd::radial {

// Throws InputError, saying what is missing, unless the mesh is closed and consistently oriented and the rig
// has bones. `strategy` is the name to begin the error text with.
void require_radial_setup(const Setup& setup, const std::string& strategy);

}  // namespace cscd::radial
