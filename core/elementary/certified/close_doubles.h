#pragma once

#include "core/geometry/feature_motion.h"

// The stage of `filtered_exact` at a distance r > 0 that works in doubles and in pairs of doubles.
namespace cscd {

struct CloseResult {
  enum Kind { apart, close, unclear } kind;
  double time = 0;  // of `close`: the largest double not above the earliest time
};

CloseResult close_in_doubles(const MovingVertexFace& query, double r);
CloseResult close_in_doubles(const MovingEdgeEdge& query, double r);

}  // namespace cscd
