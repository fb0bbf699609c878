#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/geometry/feature_motion.h"

// Relative axis-aligned bounding boxes (section 6 of the paper): with the mean velocity of all points taken
// off both sets, their swept boxes shrink to the relative motion.
//
// Why a strict comparison of rounded numbers proves the sets apart: the common translation may be any vector,
// so the rounding of the mean itself does not matter; each translated coordinate is one correctly rounded
// subtraction, and rounding is monotone, so fl(x) < fl(y) implies x < y.
namespace cscd {

template <std::size_t N, std::size_t M>
bool relative_boxes_apart(const MovingPoint (&a)[N], const MovingPoint (&b)[M]) {
  for (int axis = 0; axis < 3; ++axis) {
    double mean = 0;
    for (const MovingPoint& p : a) mean += p.end[axis] - p.start[axis];
    for (const MovingPoint& p : b) mean += p.end[axis] - p.start[axis];
    mean /= static_cast<double>(N + M);
    if (!std::isfinite(mean)) continue;  // overflow: this axis says nothing

    double low_a = a[0].start[axis], high_a = low_a, low_b = b[0].start[axis], high_b = low_b;
    for (const MovingPoint& p : a) {
      const double start = p.start[axis], end = p.end[axis] - mean;
      low_a = std::min({low_a, start, end});
      high_a = std::max({high_a, start, end});
    }
    for (const MovingPoint& p : b) {
      const double start = p.start[axis], end = p.end[axis] - mean;
      low_b = std::min({low_b, start, end});
      high_b = std::max({high_b, start, end});
    }
    if (high_a < low_b || high_b < low_a) return true;
  }
  return false;
}

inline bool relative_boxes_apart(const MovingVertexFace& query) {
  const MovingPoint vertex[1] = {query.vertex};
  return relative_boxes_apart(vertex, query.corner);
}
inline bool relative_boxes_apart(const MovingEdgeEdge& query) {
  return relative_boxes_apart(query.first, query.second);
}

}  // namespace cscd
