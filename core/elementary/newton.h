#pragma once

#include "core/elementary/elementary_test.h"

namespace cscd {

// The paper's elementary test: non-penetration filter, then interval Newton on the coplanarity cubic.
Answer newton_vertex_face(const MovingVertexFace& query);
Answer newton_edge_edge(const MovingEdgeEdge& query);

}  // namespace cscd
