#pragma once

#include "scenes/hard/family.h"
#include "scenes/hard/lattice.h"

// The families. Each family is defined in its own file.
namespace cscd::scenes::hard {

extern const Family kCoplanarSliding, kParallel, kThroughBorder, kGrazing, kIntervalEnds, kNeedles,
    kCollapsed, kAtRest, kCommonMotion, kFarAway, kExtremeScale, kCancelling, kFoldedNeighbours, kSymmetric,
    kSmallIntegers;

}  // namespace cscd::scenes::hard
