#pragma once

#include "core/fast/look/patch_lanes.h"
#include "core/geometry/shorts32.h"

// Bounds of moving points at both ends of an interval. Interpolated linearly between the ends, they hold at
// every t ("time-linear"), because every vertex moves in a straight line. A bound is the range of projections
// along each of eight directions. There are bounds of the nodes of the tree and bounds of triangles.
//
// A descent reads the bounds of nodes more than anything else, so bounds are 16-bit integers, in steps of a
// grid: the bounds of a node fit one cache line, and one comparison takes both ends of sixteen triangles.
//
// Rounding (rule outward-rounding, core/soundness.md). All numbers here are in steps of the grid. A
// coordinate is at most 16000. Its own error and the rounding of its product with the steps put it off by at
// most 0.002. A sum of two such coordinates in float is off by at most 0.006.
//
// Nodes: coordinates are rounded to the nearest integer before they are summed, so a projection is off by at
// most 1.004. The bounds are widened by 1, which leaves at most 0.004.
//
// Triangles: the sums are rounded, so a projection is off by at most 0.506. The greatest projections are
// widened by 1, the least are not.
//
// An integer that is greater than another is greater by at least 1. So two nodes that are found apart are at
// least 1 - 2 * 0.004 apart, a triangle and a node at least 1 - 0.004 - 0.506, two triangles at least
// 2 - 2 * 0.506.
namespace cscd::fast {

// The directions are x, y, z, x+y, x+z, y+z, x-y, x-z, as in Kdop16.
inline constexpr std::size_t kDirections = 8;

// Bounds of all points below a node. Pair k holds, for the start and for the end, the least projection along
// direction k. Pair kDirections + k holds the least projections along the negative of that direction.
struct NodeBounds {
  Short32 at;
};

// Bounds of the triangles of a patch. For direction k, pair l of `low` holds, for the start and for the end,
// the least projection of triangle l; pair l of `high` holds the greatest projections, plus one step.
struct TriangleBounds {
  Short32 low[kDirections], high[kDirections];
};

// Returns the bounds of all points of both.
inline NodeBounds united(const NodeBounds& a, const NodeBounds& b) {
  return {smaller(a.at, b.at)};
}

// Returns bounds of the whole paths of the points: at both ends, the union of both ends.
inline NodeBounds swept(const NodeBounds& b) {
  return {smaller(b.at, turned_pairs(b.at))};
}
TriangleBounds swept(const TriangleBounds& bounds);

// True is a proof that the points of a and b are apart at every t: along one direction, all points of a lie
// on the same side of all points of b at both ends, and therefore at every t.
inline bool apart(const NodeBounds& a, const NodeBounds& b) {
  const Mask32 over = above(a.at, -swapped(b.at));
  return (over & over >> 1 & 0x55555555U) != 0;
}

// Returns the triangles in `mask` that may come near: those not proven apart from the node's bounds, or from
// triangle `lane` of another patch.
Mask16 near(const TriangleBounds& triangles, Mask16 mask, const NodeBounds& other);
Mask16 near(const TriangleBounds& triangles, Mask16 mask, const TriangleBounds& others, std::size_t lane);

// Returns bounds that are proven apart from no others.
inline NodeBounds unbounded() {
  return {Short32{} - std::int16_t{32767}};
}

// The grid of one interval, in whose steps bounds are counted.
class Grid {
 public:
  // For local positions whose coordinates are off by at most `error`. The error must be at least 2^-24 of the
  // largest coordinate: that keeps every coordinate within 16000 steps.
  explicit Grid(float error) : steps_(kSteps * 0x1p-24F / error) {}

  float steps() const { return steps_; }  // in one unit of local length
  NodeBounds bounds_of(const PatchLanes& lanes) const;
  TriangleBounds bounds_of_triangles(const PatchLanes& lanes, const Patch& patch) const;

 private:
  static constexpr float kSteps = 16000;
  float steps_;
};

}  // namespace cscd::fast
