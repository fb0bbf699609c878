#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "core/fast/look/local_positions.h"
#include "core/geometry/lanes16.h"

// Parting: a proof that two triangles do not touch, by the moving plane of one of them.
//
// The plane of a triangle B *parts* B from a triangle A if, at every t, all corners of A that are not corners
// of B lie strictly on one side of the plane, and A has at least one such corner. Then no feature of A
// touches a feature of B with which it shares no vertex, whatever the start.
//
// Proof. Let a point of a feature of A lie in the plane. Then it lies in the hull of those corners of the
// feature that B has too. B has a plane, so B is not degenerate. Therefore a feature of B contains that point
// only if it has one of these corners, too.
namespace cscd::fast {

// Sixteen pairs of triangles, given by the vertices of the first and of the second triangle of each pair.
struct PairLanes {
  using Vertices = std::array<std::array<std::int32_t, kLanes16>, 3>;  // [corner][pair]
  Vertices first{}, second{};
};
// Returns the pairs that the plane of neither triangle parts. The triangles of a pair must differ. `error` is
// the error of every coordinate (look/local_positions.h).
Mask16 not_parted(std::span<const LocalPositions::Record> records, const PairLanes& pairs, float error);

}  // namespace cscd::fast
