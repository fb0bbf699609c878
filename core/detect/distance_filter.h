#pragma once

#include "core/detect/carried_pairs.h"
#include "core/mesh/motion.h"

namespace cscd {

// Returns the feature pairs of two triangles, among those at some places, that may come within a distance of
// each other, finite and above 0. Each pair is held against the directions between nearest points that its
// features may have half-way through the interval. Points move in straight lines, so where the gap along a
// fixed direction exceeds the distance at both ends, it does so at every t.
CarriedPlaces not_farther_than(double distance, const Motion& motion, const Triangle& a, const Triangle& b,
                               CarriedPlaces places);

}  // namespace cscd
