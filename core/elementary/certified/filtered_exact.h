#pragma once

#include <span>

#include "core/elementary/question/elementary_test.h"

namespace cscd {

// Decides contact exactly, for any finite coordinates. The time of a contact is the largest double that is
// not above the earliest time: it is never late, early by less than 2^-53, and the same as the oracle's.
Answer filtered_exact_vertex_face(const MovingVertexFace& query);
Answer filtered_exact_edge_edge(const MovingEdgeEdge& query);

// Answers many queries, eight side by side.
void filtered_exact(std::span<const MovingVertexFace> queries, std::span<Answer> answers);
void filtered_exact(std::span<const MovingEdgeEdge> queries, std::span<Answer> answers);

// Tells exactly which queries are close, each at the distance of the same number, which is above 0. Times are
// as for contact.
void filtered_exact_close(std::span<const MovingVertexFace> queries, std::span<const double> distances,
                          std::span<Answer> answers);
void filtered_exact_close(std::span<const MovingEdgeEdge> queries, std::span<const double> distances,
                          std::span<Answer> answers);

// The last stage that was needed for the answer and its time.
enum class ExactStage { filter, doubles, integers, oracle };
ExactStage filtered_exact_stage(const MovingVertexFace& query);
ExactStage filtered_exact_stage(const MovingEdgeEdge& query);
ExactStage filtered_exact_close_stage(const MovingVertexFace& query, double r);
ExactStage filtered_exact_close_stage(const MovingEdgeEdge& query, double r);

}  // namespace cscd
