#pragma once

#include "core/elementary/question/elementary_test.h"

namespace cscd {

// Inclusion-based root finding (Snyder 1992, Wang et al. 2021). `apart` proves that the features never touch.
// `contact` says that at some t at or after the answer's time, which is never later than the first contact,
// the features are within sqrt(3) times the tolerance (and the rounding error of their coordinates) of each
// other. `undecided` is the answer after so many steps; its time is a lower bound too. `tolerance` is in
// extents of the query.
Answer inclusion_vertex_face(const MovingVertexFace& query, const TestParameters& parameters);
Answer inclusion_edge_edge(const MovingEdgeEdge& query, const TestParameters& parameters);

}  // namespace cscd
