#pragma once

#include <array>
#include <span>

#include "core/elementary/question/elementary_test.h"
#include "core/geometry/lanes.h"

namespace cscd {

// Answers to some of eight queries.
struct LaneAnswers {
  unsigned decided = 0;  // bit l is set if answer[l] holds the answer to query l
  std::array<Answer, kLanes> answer;
};

// Answers queries side by side in double precision, at most eight, as far as that precision can prove the
// answers. It decides queries whose points are never in one plane, and most queries whose points certainly
// come into one plane once. The answers, times included, equal those of filtered_exact one by one, because
// there is only one right answer.
LaneAnswers decide_in_lanes(std::span<const MovingVertexFace> queries);
LaneAnswers decide_in_lanes(std::span<const MovingEdgeEdge> queries);

}  // namespace cscd
