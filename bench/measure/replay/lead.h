#pragma once

#include <cstddef>

#include "core/detect/strategy.h"
#include "scenes/clip/clip.h"

namespace cscd::bench {

// What a strategy that follows the surface counts depends on the intervals before. So that every measurement
// of an interval is one of the same thing, such a detector forgets everything and is then asked the kLead
// intervals before that one, or as many as there are. This is its state in a simulation that goes on from
// step to step.
inline constexpr std::size_t kLead = 24;

// Warms up strategies that adapt to the surface (Strategy::follows), and does nothing for the others. Load
// the interval again afterwards, because the clip then holds another one.
void lead_up(const Strategy& strategy, Detector& detector, scenes::ClipSource& clip, std::size_t interval);

}  // namespace cscd::bench
