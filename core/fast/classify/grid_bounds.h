#pragma once

#include "core/fast/classify/patch_lanes.h"
#include "core/geometry/simd_shorts.h"

// Bounds of moving points at both ends of an interval. Interpolated between the ends they are valid at every
// t. The nodes of the tree have such bounds, which a descent reads more than anything else, and so have
// triangles. Bounds are whole steps of a grid: the bounds of a node fit one cache line, and one comparison
// takes both ends of sixteen triangles.
//
// Rounding, in steps. A coordinate, of at most 16000, is off by 0.002 with its product, and a sum of two
// coordinates in float by 0.006. The coordinates of a node are rounded to the nearest step before they are
// summed, which makes 1.004, and give way by one step. The sums of a triangle are rounded, which makes 0.506,
// and the greatest give way by one step. An integer that lies beyond another does so by at least one. So two
// nodes that are apart are so by 1 - 2 * 0.004, a triangle and a node by 1 - 0.004 - 0.506 or more, and two
// triangles by 2 - 2 * 0.506.
namespace cscd::fast {

// The directions are x, y, z, x+y, x+z, y+z, x-y and x-z, as those of Kdop16.
inline constexpr std::size_t kDirections = 8;

// Pair k holds, for each end, the least projection along direction k. Pair kDirections + k holds the least
// projection along its negative.
struct NodeBounds {
  Short32 at;
};

// The bounds of a patch's triangles. Pair l of direction k holds, for each end, the least projection of
// triangle l, or the greatest projection and one step more.
struct TriangleBounds {
  Short32 low[kDirections], high[kDirections];
};

// Returns the bounds of all points of both.
inline NodeBounds united(const NodeBounds& a, const NodeBounds& b) {
  return {smaller(a.at, b.at)};
}

// Returns bounds of the whole paths instead of both ends.
inline NodeBounds swept(const NodeBounds& b) {
  return {smaller(b.at, turned_pairs(b.at))};
}
TriangleBounds swept(const TriangleBounds& bounds);

// True is a proof: along one direction one node lies on the same side of the other at both ends, and
// therefore at every t.
inline bool apart(const NodeBounds& a, const NodeBounds& b) {
  const Mask32 over = above(a.at, -swapped(b.at));
  return (over & over >> 1 & 0x55555555U) != 0;
}

// The same of the start of the interval alone.
inline bool apart_at_start(const NodeBounds& a, const NodeBounds& b) {
  return (above(a.at, -swapped(b.at)) & 0x55555555U) != 0;
}

// Returns the triangles in `mask` that are not proven apart from a node, or from triangle `lane` of another
// patch.
Mask16 near(const TriangleBounds& triangles, Mask16 mask, const NodeBounds& other);
Mask16 near(const TriangleBounds& triangles, Mask16 mask, const TriangleBounds& others, std::size_t lane);

// Bounds that overlap everything.
inline NodeBounds unbounded() {
  return {Short32{} - std::int16_t{32767}};
}

// The grid of one interval, in whose steps bounds are counted.
class Grid {
 public:
  // A grid for local positions whose coordinates are off by at most `error`, which is at least 2^-24 of the
  // largest coordinate. All bounds grow by `margin`, so that what is apart is so by more than twice as much.
  explicit Grid(float error, float margin = 0);

  float steps() const { return steps_; }  // steps of the grid in a local unit
  bool has_margin() const { return distance_ != 0; }
  float distance() const { return distance_; }  // twice the margin
  NodeBounds bounds_of(const PatchLanes& lanes) const;
  TriangleBounds bounds_of_triangles(const PatchLanes& lanes, const Patch& patch) const;

 private:
  static constexpr float kSteps = 16000;
  float steps_, distance_;
  Short32 margin_{};  // of a node, in steps along each direction
};

}  // namespace cscd::fast
