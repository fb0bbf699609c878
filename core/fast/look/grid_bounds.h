#pragma once

#include "core/fast/look/patch_lanes.h"
#include "core/geometry/shorts32.h"

// Bounds of moving points that are valid at every t when interpolated between both ends ("time-linear"): of
// the nodes of the tree, which is what a descent reads most, and of triangles. Hence in whole steps of a
// grid, of which a node's fit one cache line, and a comparison takes both ends of sixteen triangles.
//
// Rounding, in steps. A coordinate, of at most 16000, is off by 0.002 with its product, a sum of two in float
// by 0.006. A node's coordinates are rounded to the nearest before they are summed, which makes 1.004, and
// give way by one. A triangle's sums are rounded, which makes 0.506, and the greatest give way by one. Of
// integers, what lies beyond another does so by one: two nodes that are apart are so by 1 - 2 * 0.004, a
// triangle and a node by 1 - 0.004 - 0.506 or more, two triangles by 2 - 2 * 0.506.
namespace cscd::fast {

// Directions: x, y, z, x+y, x+z, y+z, x-y, x-z, those of Kdop16.
inline constexpr std::size_t kDirections = 8;

// Pair k holds for each end the least projection along direction k, pair kDirections + k the least along its
// negative.
struct NodeBounds {
  Short32 at;
};

// Of the triangles of a patch: pair l of direction k holds for each end the least projection of triangle l,
// or the greatest, and one step more.
struct TriangleBounds {
  Short32 low[kDirections], high[kDirections];
};

inline NodeBounds united(const NodeBounds& a, const NodeBounds& b) {
  return {smaller(a.at, b.at)};
}

// Bounds of the whole paths.
inline NodeBounds swept(const NodeBounds& b) {
  return {smaller(b.at, turned_pairs(b.at))};
}
TriangleBounds swept(const TriangleBounds& bounds);

// True is a proof: along one direction one lies on the same side of the other at both ends, therefore always.
inline bool apart(const NodeBounds& a, const NodeBounds& b) {
  const Mask32 over = above(a.at, -swapped(b.at));
  return (over & over >> 1 & 0x55555555U) != 0;
}

// Which of the triangles in `mask` are not proven apart from the bounds, or from triangle `lane` of another
// patch.
Mask16 near(const TriangleBounds& triangles, Mask16 mask, const NodeBounds& other);
Mask16 near(const TriangleBounds& triangles, Mask16 mask, const TriangleBounds& others, std::size_t lane);

// Overlaps everything.
inline NodeBounds unbounded() {
  return {Short32{} - std::int16_t{32767}};
}

class Grid {
 public:
  // Of local positions whose coordinates are off by `error`, at least 2^-24 of the largest.
  explicit Grid(float error) : steps_(kSteps * 0x1p-24F / error) {}

  float steps() const { return steps_; }  // of a local unit
  NodeBounds bounds_of(const PatchLanes& lanes) const;
  TriangleBounds bounds_of_triangles(const PatchLanes& lanes, const Patch& patch) const;

 private:
  static constexpr float kSteps = 16000;
  float steps_;
};

}  // namespace cscd::fast
