#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "core/fast/look/local_positions.h"
#include "core/geometry/lanes16.h"

// Pairs that the plane of one of the two triangles parts.
//
// If at every t the corners of a triangle A that B does not have lie strictly on one side of B's plane, and
// there are any, no feature of A touches one of B that has no vertex in common with it, whatever the start.
// For a point of a feature of A that lies in that plane lies in what its shared corners span; and B, which
// has a plane, is no degenerate triangle, so a feature of B meets that only where it has one of these
// corners, too.
namespace cscd::fast {

// Sixteen pairs of triangles by their vertices: [corner][lane].
struct PairLanes {
  using Vertices = std::array<std::array<std::int32_t, kLanes16>, 3>;
  Vertices first{}, second{};
};
// Pairs of two different triangles that neither plane parts. `error`: of every coordinate.
Mask16 not_parted(std::span<const LocalPositions::Record> records, const PairLanes& pairs, float error);

}  // namespace cscd::fast
