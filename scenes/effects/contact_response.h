#pragma once

#include <functional>
#include <memory>

#include "core/detect/strategy.h"
#include "scenes/effects/effect.h"

namespace cscd::scenes {

// Makes the effect contact_response with another detector of first contacts than our own. Tests use this to
// put in broken detectors.
using MakeDetector = std::function<std::unique_ptr<Detector>(const StrategyInput& setup)>;
std::unique_ptr<Effect> make_contact_response(const Parameters& parameters, const Shape& shape,
                                              const MakeDetector& first);

}  // namespace cscd::scenes
