#pragma once

#include <limits>
#include <span>

#include "core/fast/classify/local_positions.h"
#include "core/fast/prepare/following_point.h"

namespace cscd::fast {

// Where an observer stands at both ends of an interval, [end][axis], in local coordinates; it moves in a
// straight line between the two. A viewpoint is exactly these numbers and has no error. The vertices that are
// seen from it have an error, which the orientations allow for.
struct Viewpoint {
  float at[2][3];
  // More than the distance of any vertex from the viewpoint along an axis, including the error of the vertex.
  // Infinite until reach_of() has computed it.
  float reach = std::numeric_limits<float>::infinity();
};

// Returns the `reach` of a viewpoint among vertices whose coordinates are off by at most `error`, which must
// be at least 2^-24 of the largest coordinate.
float reach_of(const Viewpoint& viewpoint, float error);

// Returns the viewpoint of an observer that follows the vertices with these records (local_positions.h).
Viewpoint placed(const FollowingPoint& point, std::span<const LocalPositions::Record> records);

}  // namespace cscd::fast
