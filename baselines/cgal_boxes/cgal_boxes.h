#pragma once

#include "core/detect/strategy.h"

namespace cscd {

// Takes CGAL's box_self_intersection_d (Zomorodian and Edelsbrunner, "Fast Software for Box Intersections",
// IJCGA 12(1-2), 2002) as the broad phase.
Prepared make_cgal_boxes(const StrategyInput& setup);

}  // namespace cscd
