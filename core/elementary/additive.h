#pragma once

#include "core/elementary/question/elementary_test.h"

namespace cscd {

// Additive continuous collision detection (Li et al. 2021). `tolerance` is the share of the distance at t = 0
// that counts as touching, in (0, 1). The time is early by as much as the features need for that share.
// Features that touch at t = 0 are in contact then.
Answer additive_vertex_face(const MovingVertexFace& query, const TestParameters& parameters);
Answer additive_edge_edge(const MovingEdgeEdge& query, const TestParameters& parameters);

}  // namespace cscd
