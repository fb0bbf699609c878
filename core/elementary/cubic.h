#pragma once

#include "core/elementary/question/elementary_test.h"

namespace cscd {

// The classic test of cloth simulation (Provot 1997; Bridson, Fedkiw and Anderson 2002; see cubic.cpp).
// `tolerance` is the distance at which features count as touching, in extents of the relative query
// (question/extent.h). The verdict is never `undecided`.
Answer cubic_vertex_face(const MovingVertexFace& query, const TestParameters& parameters);
Answer cubic_edge_edge(const MovingEdgeEdge& query, const TestParameters& parameters);

}  // namespace cscd
