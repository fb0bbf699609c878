#pragma once

#include "core/elementary/question/elementary_test.h"

namespace cscd {

// Additive conservative advancement (Li, Kaufman and Jiang 2021; see additive.cpp).
//
// `tolerance`, in (0, 1), is a share of the distance at t = 0: features count as touching once their distance
// has fallen to that share. Hence the time of a contact is early, by the time that the features need for the
// rest of the way. Features that touch at t = 0 are in contact at t = 0. `steps` is the largest number of
// advances.
Answer additive_vertex_face(const MovingVertexFace& query, const TestParameters& parameters);
Answer additive_edge_edge(const MovingEdgeEdge& query, const TestParameters& parameters);

}  // namespace cscd
