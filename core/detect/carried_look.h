#pragma once

#include <optional>

#include "core/detect/carried_pairs.h"
#include "core/mesh/motion.h"

namespace cscd {

// Single-precision version of not_filtered() (carried_filter.h). Evaluates all fifteen feature pairs of two
// triangles side by side, with bounds on what single precision loses. Returns nothing if rounding leaves any
// of them undecided; the caller then asks the double-precision version.
std::optional<CarriedPlaces> not_filtered_at_a_look(const Motion& motion, const Triangle& a,
                                                    const Triangle& b, CarriedPlaces places);

}  // namespace cscd
