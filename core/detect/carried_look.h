#pragma once

#include <optional>

#include "core/detect/carried_pairs.h"
#include "core/mesh/motion.h"

namespace cscd {

// A *look* is the single-precision version of not_filtered() (carried_filter.h). It evaluates all fifteen
// feature pairs of two triangles side by side, with bounds for the rounding of single precision. Returns
// exactly the places that not_filtered() returns, or nullopt if rounding leaves any of `places` undecided;
// the caller then asks not_filtered().
std::optional<CarriedPlaces> not_filtered_at_a_look(const Motion& motion, const Triangle& a,
                                                    const Triangle& b, CarriedPlaces places);

}  // namespace cscd
