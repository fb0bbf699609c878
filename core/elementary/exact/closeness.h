#pragma once

#include <optional>

#include "core/elementary/exact/time_enclosure.h"
#include "core/geometry/feature_motion.h"

namespace cscd::exact {

// The oracle at a distance r > 0: decides whether the distance of the closed features is at most r at some t
// in [0, 1], for the coordinates and r exactly as they stand, any finite doubles. Returns an enclosure of the
// earliest such t, or nullopt if there is none. Nothing is rounded. The method is in closeness.cpp.
std::optional<TimeEnclosure> first_closeness(const MovingVertexFace& query, double r);
std::optional<TimeEnclosure> first_closeness(const MovingEdgeEdge& query, double r);

// True if the closed features are within r > 0 of each other at the start of the query. A filter in floating
// point answers most calls, and exact arithmetic answers the rest.
bool close_at_start(const MovingVertexFace& query, double r);
bool close_at_start(const MovingEdgeEdge& query, double r);

}  // namespace cscd::exact
