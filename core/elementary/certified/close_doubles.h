#pragma once

#include "core/geometry/feature_motion.h"

// The stage of `filtered_exact` at a distance r > 0 that works in doubles and in pairs of doubles.
namespace cscd {

struct CloseResult {
  // `unclear_start` leaves open whether the features are close at t = 0.
  enum Kind { apart, close, unclear, unclear_start } kind;
  // Of `close`, the largest double not above the earliest time; of `unclear`, a time before which the
  // features are not close, if they are not close at t = 0.
  double time = 0;
  int likely_case = 0;  // by which the features are probably nearest at t = 0 (exact/closeness_cases.h)
};

// With `apart_at_start`, the features are known to be farther than r apart at t = 0.
CloseResult close_in_doubles(const MovingVertexFace& query, double r, bool apart_at_start = false);
CloseResult close_in_doubles(const MovingEdgeEdge& query, double r, bool apart_at_start = false);

// How features come to their distance at t = 1.
struct EndOfMotion {
  int likely_case;  // by which they are probably nearest then
  // If their distance then is exactly r, they are certainly farther apart at all times before.
  bool from_afar;
};
EndOfMotion end_of_motion(const MovingVertexFace& query, double r);
EndOfMotion end_of_motion(const MovingEdgeEdge& query, double r);

// The cases of nearest features that may decide at some t in [from, 1] that the features are close, as bits
// by their numbers. All others certainly do not.
unsigned possible_cases(const MovingVertexFace& query, double r, double from);
unsigned possible_cases(const MovingEdgeEdge& query, double r, double from);

}  // namespace cscd
