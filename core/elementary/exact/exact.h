#pragma once

#include <optional>

#include "core/elementary/exact/time_enclosure.h"
#include "core/geometry/feature_motion.h"

namespace cscd::exact {

// The referee. Decides, for the coordinates exactly as they stand (any finite doubles), whether the closed
// features touch at some t in [0, 1], and encloses the earliest such t. Nothing is rounded. Slow (tens of
// microseconds): it has the last word, it does not have to be first.
std::optional<TimeEnclosure> first_contact(const MovingVertexFace& query);
std::optional<TimeEnclosure> first_contact(const MovingEdgeEdge& query);

}  // namespace cscd::exact
