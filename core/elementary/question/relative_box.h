#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/base/rounding.h"
#include "core/geometry/feature_motion.h"

// Relative axis-aligned bounding boxes (section 6 of the paper). Subtracting the mean velocity of all points
// from both sets of points shrinks their swept boxes to the relative motion.
//
// A strict comparison of the rounded numbers proves the sets apart (rule relative-motion, core/soundness.md),
// for two reasons. The common translation may be any vector, so the rounding of the mean does not matter. And
// each translated coordinate is one correctly rounded subtraction, and rounding is monotone, so fl(x) < fl(y)
// implies x < y. At a distance r > 0 the gap between the coordinates has to exceed r by more than the
// roundings of both.
namespace cscd {

// True proves that the hulls of the moving points `a` and of the moving points `b` are farther than r apart
// at every t in [0, 1].
template <std::size_t N, std::size_t M>
bool relative_boxes_apart(const MovingPoint (&a)[N], const MovingPoint (&b)[M], double r = 0) {
  const auto below = [r](double x, double y) {
    return r == 0 ? x < y : (y - x) - 4 * kUnitRoundoff * (std::abs(x) + std::abs(y)) > r;
  };
  for (int axis = 0; axis < 3; ++axis) {
    double mean = 0;
    for (const MovingPoint& p : a) mean += p.end[axis] - p.start[axis];
    for (const MovingPoint& p : b) mean += p.end[axis] - p.start[axis];
    mean /= static_cast<double>(N + M);
    if (!std::isfinite(mean)) continue;  // after an overflow this axis proves nothing

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
    if (below(high_a, low_b) || below(high_b, low_a)) return true;
  }
  return false;
}

// True proves that the two features never touch, or for r > 0 that they are never close.
inline bool relative_boxes_apart(const MovingVertexFace& query, double r = 0) {
  const MovingPoint vertex[1] = {query.vertex};
  return relative_boxes_apart(vertex, query.corner, r);
}
inline bool relative_boxes_apart(const MovingEdgeEdge& query, double r = 0) {
  return relative_boxes_apart(query.first, query.second, r);
}

}  // namespace cscd
