#pragma once

#include <optional>

#include "core/elementary/exact/time_enclosure.h"
#include "core/geometry/feature_motion.h"

namespace cscd::exact {

// The oracle: the elementary test whose answer is final (the method is in exact.cpp). It takes the
// coordinates exactly as they stand, any finite doubles, and decides whether the closed features touch at
// some t in [0, 1]. It returns an enclosure of the earliest such t, or nullopt if there is none. Nothing is
// rounded. A query takes tens of microseconds.
std::optional<TimeEnclosure> first_contact(const MovingVertexFace& query);
std::optional<TimeEnclosure> first_contact(const MovingEdgeEdge& query);

}  // namespace cscd::exact
