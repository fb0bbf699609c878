#pragma once

#include <optional>
#include <string>

#include "core/detect/strategy.h"

namespace cscd::bench {

// Says why a strategy cannot be made for a mesh (Strategy::needs); nothing where it can.
std::optional<std::string> why_not(const Strategy& strategy, const TriangleMesh& mesh, bool has_bones);

}  // namespace cscd::bench
