#pragma once

#include "core/elementary/question/elementary_test.h"

namespace cscd {

// The classic test of cloth simulation (Bridson et al. 2002). `tolerance` is the distance, in extents of the
// relative query, at which features count as touching. The answer is never `undecided`.
Answer cubic_vertex_face(const MovingVertexFace& query, const TestParameters& parameters);
Answer cubic_edge_edge(const MovingEdgeEdge& query, const TestParameters& parameters);

}  // namespace cscd
