#pragma once

#include "core/elementary/question/elementary_test.h"

namespace cscd {

// Inclusion-based root finding (Snyder 1992; Wang et al. 2021; see inclusion.cpp).
//
// `tolerance` is a length in extents of the query (question/extent.h); `steps` is the largest number of boxes
// that the search may look at.
// - `apart` proves that the features never touch.
// - `contact` means that at some t at or after the answer's time the features are within sqrt(3) times the
//   tolerance of each other, plus the rounding error of their coordinates. The answer's time is never later
//   than the first contact.
// - `undecided` means that the steps ran out. Its time is still a lower bound of the first contact's time.
Answer inclusion_vertex_face(const MovingVertexFace& query, const TestParameters& parameters);
Answer inclusion_edge_edge(const MovingEdgeEdge& query, const TestParameters& parameters);

}  // namespace cscd
