#pragma once

#include "core/detect/strategy.h"

namespace cscd {

// The Flexible Collision Library's continuous mesh traversal of a model with itself, over refitted 16-DOPs
// (Pan, Chitta and Manocha, "FCL: A General Purpose Library for Collision and Proximity Queries", ICRA 2012).
// The strategy asks its own elementary tests, whatever test the setup names. Its `detect` throws InputError
// if a coordinate lies beyond kFclFarthest (fcl_elementary.h).
Prepared make_fcl(const StrategyInput& setup);

}  // namespace cscd
