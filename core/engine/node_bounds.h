#pragma once

#include "core/engine/patch_lanes.h"
#include "core/geometry/shorts32.h"

// Bounds of the nodes of the tree: what a descent reads most, hence in whole steps of a grid, in one cache
// line.
//
// Rounding: a coordinate of at most 16000 steps rounds to the nearest, which is off by 0.5 and, for the error
// of the coordinate and the product, by 0.002 more; a sum of two by 1.004. Bounds give way by one step; two
// that are apart nevertheless lie two steps and one more apart before, as all of them are integers.
namespace cscd::fast {

// Bounds of moving points that are valid at every t when interpolated between both ends ("time-linear"): pair
// k holds for each end the least projection along direction k (patch_lanes.h), pair kDirections + k the least
// along its negative.
struct NodeBounds {
  Short32 at;
};

inline NodeBounds united(const NodeBounds& a, const NodeBounds& b) {
  return {smaller(a.at, b.at)};
}

// Bounds of the whole paths.
inline NodeBounds swept(const NodeBounds& b) {
  const auto pairs = bits_as<Int16>(b.at);
  return {smaller(b.at, bits_as<Short32>((pairs << 16) | ((pairs >> 16) & 0xffff)))};
}

// True is a proof: along one direction one lies on the same side of the other at both ends, therefore always.
inline bool apart(const NodeBounds& a, const NodeBounds& b) {
  const Mask32 over = above(a.at, -swapped(b.at));
  return (over & over >> 1 & 0x55555555U) != 0;
}

// Overlaps everything.
inline NodeBounds unbounded() {
  return {Short32{} - std::int16_t{32767}};
}

class Grid {
 public:
  // Of local positions whose coordinates are off by `error`, at least 2^-24 of the largest.
  explicit Grid(float error) : steps_(kSteps * 0x1p-24F / error), step_(error * 0x1p24F / kSteps) {}

  NodeBounds bounds_of(const PatchLanes& lanes) const;
  // In local units, outward.
  MovingBounds in_units(const NodeBounds& bounds) const;

 private:
  static constexpr float kSteps = 16000;
  float steps_;  // of a unit
  float step_;   // in units
};

}  // namespace cscd::fast
