#pragma once

#include "core/elementary/question/elementary_test.h"

namespace cscd {

// The paper's elementary test (section 7.1): the non-penetration filter, then interval Newton on the
// coplanarity cubic. newton_search.h describes the method and the limits of its answers.
Answer newton_vertex_face(const MovingVertexFace& query);
Answer newton_edge_edge(const MovingEdgeEdge& query);

// The same test in single precision, as games have it. Coordinates are rounded to floats first, which alone
// may move features by 2^-24 of their distance from the origin.
Answer newton_float_vertex_face(const MovingVertexFace& query);
Answer newton_float_edge_edge(const MovingEdgeEdge& query);

}  // namespace cscd
