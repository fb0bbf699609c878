#pragma once

#include "core/detect/carried_pairs.h"
#include "core/mesh/motion.h"

namespace cscd {

// The non-penetration filter (core/elementary/question/filter.h) for all feature pairs that two triangles
// carry. Takes two different triangles and the places (carried_pairs.h) to look at. Returns the places among
// them whose feature pairs the filter cannot prove apart. The six vertices are loaded once; the points and
// edges of the fifteen pairs are permutations of the registers that hold them.
CarriedPlaces not_filtered(const Motion& motion, const Triangle& a, const Triangle& b, CarriedPlaces places);

}  // namespace cscd
