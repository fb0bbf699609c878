#pragma once

#include <array>
#include <span>

#include "core/elementary/question/elementary_test.h"
#include "core/geometry/simd_doubles.h"

namespace cscd {

// The answers of filtered_exact to some of eight queries: one bit for each query that has an answer.
struct LaneAnswers {
  unsigned decided = 0;  // bit l is set if answer[l] holds the answer to query l
  std::array<Answer, kLanes> answer;
};

// Answers up to eight queries side by side in double precision: those that are never in one plane, or that
// certainly are once. Whatever is decided is what the scalar stages say, time included, as there is but one
// right answer.
LaneAnswers decide_in_lanes(std::span<const MovingVertexFace> queries);
LaneAnswers decide_in_lanes(std::span<const MovingEdgeEdge> queries);

}  // namespace cscd
