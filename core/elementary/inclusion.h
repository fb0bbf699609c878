#pragma once

#include "core/elementary/question/elementary_test.h"

namespace cscd {

// `apart` proves that the features never touch. `contact`: at some t at or after the answer's time, the
// features are within sqrt(3) times the tolerance (and the rounding error of their coordinates) of each
// other; the time is never later than the first contact. `undecided` after so many steps, its time still a
// lower bound. `tolerance` in extents of the query.
Answer inclusion_vertex_face(const MovingVertexFace& query, const TestParameters& parameters);
Answer inclusion_edge_edge(const MovingEdgeEdge& query, const TestParameters& parameters);

}  // namespace cscd
