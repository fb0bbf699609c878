#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "core/fast/classify/local_positions.h"
#include "core/geometry/simd_floats.h"

// Pairs of triangles that a plane parts: the moving plane of one triangle, or one that is parallel to an edge
// of each.
//
// Let A and B be triangles, and let A have corners that B does not have. If these corners lie strictly on one
// side of B's plane at every t, no feature of A touches a feature of B that shares no vertex with it,
// whatever the start. For a point of A's feature that lies in B's plane lies in the hull of the shared
// corners. B has a plane, so B is not degenerate, and a feature of B meets that hull only where it has one of
// these corners itself.
namespace cscd::fast {

// Sixteen pairs of triangles by their vertices, [corner][lane].
struct PairLanes {
  using Vertices = std::array<std::array<std::int32_t, kLanes16>, 3>;  // [corner][pair]
  Vertices first{}, second{};
};
// Returns the pairs that neither of the two planes parts. `error` bounds the error of every coordinate. The
// triangles of a pair have to be different.
Mask16 not_parted(std::span<const LocalPositions::Record> records, const PairLanes& pairs, float error);

// Returns the pairs that share a corner and those that no plane parallel to an edge of each triangle parts,
// or to an edge of one and the relative motion. The edges are taken as they lie half-way through the
// interval, and the direction at right angles to both is held fixed: triangles that lie on the same side of
// each other along a fixed direction at both ends do so at every t, because corners move in straight lines.
// Two triangles that do not turn and do not touch are always parted by the plane of one of them or by such a
// plane: their differences, from one end to the other, fill a polytope without the origin, and these are its
// faces.
Mask16 not_parted_by_edges(std::span<const LocalPositions::Record> records, const PairLanes& pairs,
                           float error);

}  // namespace cscd::fast
