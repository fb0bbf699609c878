#pragma once

#include <optional>
#include <string>

#include "core/detect/strategy.h"

namespace cscd::bench {

// Why a strategy cannot be made for a mesh; nothing where it can. Strategies that need bones or promise the
// first contact need a closed, consistently oriented surface.
std::optional<std::string> why_not(const Strategy& strategy, const TriangleMesh& mesh, bool has_bones);

}  // namespace cscd::bench
