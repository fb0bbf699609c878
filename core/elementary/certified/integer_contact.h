#pragma once

#include "core/geometry/feature_motion.h"

// Decides contacts with integers of fixed capacity (wide.h): exactly, and without allocation.
//
// The capacity suffices if the bits of the coordinates along each axis span at most some 1140 places. So a
// coordinate may be the smallest double beside others of up to 2^60. The coordinates of a simulation span 60
// to 120 places.
namespace cscd::integer {

// `gave_up` means that the query needs longer integers, or that its roots are too close for the solver
// (RootSolver, integer_roots.h). It says nothing about the features.
enum class Outcome { apart, contact, gave_up };

struct Result {
  Outcome outcome;
  double time = 0;  // for a contact: the largest double not above the earliest contact time
};

// Decides whether the features touch at some t in [0, 1], and when first.
Result first_contact(const MovingVertexFace& query);
Result first_contact(const MovingEdgeEdge& query);

// Computes the time of a known contact. The features have to touch at the only root of the coplanarity cubic
// between `low` and `high`, and the cubic has to have opposite signs at these two times.
Result contact_time(const MovingVertexFace& query, double low, double high);
Result contact_time(const MovingEdgeEdge& query, double low, double high);

}  // namespace cscd::integer
