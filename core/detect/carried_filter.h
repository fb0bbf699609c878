#pragma once

#include "core/detect/carried_pairs.h"
#include "core/mesh/motion.h"

namespace cscd {

// Returns the feature pairs of two triangles, among those at some places, that the filter
// (core/elementary/question/filter.h) cannot prove apart. The six vertices are loaded once; what fifteen
// pairs need are permutations of registers.
CarriedPlaces not_filtered(const Motion& motion, const Triangle& a, const Triangle& b, CarriedPlaces places);

}  // namespace cscd
