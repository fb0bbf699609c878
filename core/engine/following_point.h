#pragma once

#include <span>
#include <vector>

#include "core/base/ids.h"
#include "core/engine/local_positions.h"

namespace cscd::fast {

// A point that follows the surface: an affine combination of some vertices.
struct FollowingPoint {
  std::vector<VertexId> vertices;
  std::vector<float> weights;  // sum to about 1: what they sum to exactly is the point

  Vec3 at(std::span<const Vec3> positions) const;
};

// A viewpoint that moves in a straight line; [end][axis]. An observer is these numbers and has no error; a
// vertex is off by the error of its coordinates, which orientations allow for.
struct Viewpoint {
  float at[2][3];
};
Viewpoint placed(const FollowingPoint& point, std::span<const LocalPositions::Record> records);

}  // namespace cscd::fast
