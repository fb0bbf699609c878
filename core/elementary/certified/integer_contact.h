#pragma once

#include "core/geometry/feature_motion.h"

// Decides contact with integers of fixed capacity, exactly and without allocation, for coordinates whose bits
// span not too many places. Some 1140 places on each axis are allowed, so a coordinate may be the smallest of
// doubles beside others up to 2^60; the coordinates of a simulation span 60 to 120.
namespace cscd::integer {

// `gave_up` means that the query needs longer integers, or that its roots are too close for the solver
// (RootSolver, integer_roots.h). It says nothing about the features.
enum class Outcome { apart, contact, gave_up };

struct Result {
  Outcome outcome;
  double time = 0;  // for a contact: the largest double not above the earliest time
};

// Decides whether the features touch at some t in [0, 1], and when first.
Result first_contact(const MovingVertexFace& query);
Result first_contact(const MovingEdgeEdge& query);

// Returns the time alone, where the features are known to touch at the only root of the coplanarity cubic
// between two doubles, at which the cubic is known to have opposite signs.
Result contact_time(const MovingVertexFace& query, double low, double high);
Result contact_time(const MovingEdgeEdge& query, double low, double high);

}  // namespace cscd::integer
