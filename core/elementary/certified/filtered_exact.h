#pragma once

#include <span>

#include "core/elementary/question/elementary_test.h"

namespace cscd {

// Decides a contact exactly, for any finite coordinates. The verdict is never `undecided`. The time of a
// contact is the largest double that is not above the earliest contact time: it is never late, it is early by
// less than 2^-53, and it equals the referee's time.
Answer filtered_exact_vertex_face(const MovingVertexFace& query);
Answer filtered_exact_edge_edge(const MovingEdgeEdge& query);

// Answers [queries] queries, eight side by side, and writes [queries] answers.
void filtered_exact(std::span<const MovingVertexFace> queries, std::span<Answer> answers);
void filtered_exact(std::span<const MovingEdgeEdge> queries, std::span<Answer> answers);

// The last stage that the answer with its time needs (see filtered_exact.cpp), for tests and measurements.
enum class ExactStage { filter, doubles, integers, referee };
ExactStage filtered_exact_stage(const MovingVertexFace& query);
ExactStage filtered_exact_stage(const MovingEdgeEdge& query);

}  // namespace cscd
