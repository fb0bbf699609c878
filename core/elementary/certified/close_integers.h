#pragma once

#include "core/elementary/certified/integer_contact.h"
#include "core/geometry/feature_motion.h"

// Decides closeness at a distance r > 0 with integers of fixed capacity, exactly and without allocation, for
// coordinates whose bits span, together with those of r, at most 270 places. Regular grids at a distance of a
// whole number of edges bring many features that are exactly r apart, which no floating-point bound decides.
namespace cscd::integer {

// Decides whether the features are close at t = 0. `likely` is the number of the case (closeness_cases.h) by
// which they are probably nearest; the answer does not depend on it.
Outcome closeness_at_start(const MovingVertexFace& query, double r, int likely);
Outcome closeness_at_start(const MovingEdgeEdge& query, double r, int likely);

// Whether the features are exactly r apart at t = 1, as far as the likely case shows that: false says
// nothing.
bool at_distance_at_end(const MovingVertexFace& query, double r, int likely);
bool at_distance_at_end(const MovingEdgeEdge& query, double r, int likely);

// Decides whether features that are not close at t = 0 come to be close, and when first. Bit i of `cases`
// says that the case i may decide this; all others are known not to.
Result first_closeness(const MovingVertexFace& query, double r, unsigned cases);
Result first_closeness(const MovingEdgeEdge& query, double r, unsigned cases);

}  // namespace cscd::integer
