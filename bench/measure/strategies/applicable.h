#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "core/detect/strategy.h"

namespace cscd::bench {

// Says why a strategy cannot be made for a mesh (Strategy::needs); nothing where it can.
std::optional<std::string> why_not(const Strategy& strategy, const TriangleMesh& mesh, bool has_bones);

// Says whether a strategy gets the bones of a clip: always if it needs them. A strategy that can do without
// spares some work in every interval by them, and takes longer to prepare, so it gets them only for a clip of
// many intervals. Whether it is a query or a measurement makes no difference.
bool gets_bones(const Strategy& strategy, std::size_t intervals);
// Returns the set-up of a clip as the strategy gets it: without the rig if the strategy does not get bones.
StrategyInput setup_for(const Strategy& strategy, StrategyInput setup, std::size_t intervals);

}  // namespace cscd::bench
