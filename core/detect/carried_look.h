#pragma once

#include <optional>

#include "core/detect/carried_pairs.h"
#include "core/mesh/motion.h"

namespace cscd {

// What not_filtered (carried_filter.h) says, where single precision can tell: nothing where it cannot tell of
// some pair. All fifteen side by side, with bounds for what single precision loses.
std::optional<CarriedPlaces> not_filtered_at_a_look(const Motion& motion, const Triangle& a,
                                                    const Triangle& b, CarriedPlaces places);

}  // namespace cscd
