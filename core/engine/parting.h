#pragma once

#include "core/engine/patch_lanes.h"

// Pairs that the plane of one of the two triangles parts.
//
// If at every t the corners of a triangle A that B does not have lie strictly on one side of B's plane, and
// there are any, no feature of A touches one of B that has no vertex in common with it, whatever the start.
// For a point of a feature of A that lies in that plane lies in what its shared corners span; and B, which
// has a plane, is no degenerate triangle, so a feature of B meets that only where it has one of these
// corners, too.
namespace cscd::fast {

// The planes of the triangles of a patch, a corner of each, and its vertices.
struct PatchPlanes {
  PatchLanes vertices, corner;
  PatchNormals normals;
};
PatchPlanes planes_of(std::span<const LocalPositions::Record> records, const Patch& patch);

// A triangle of another patch, or of the same one.
struct PlaneOf {
  const PatchPlanes& planes;
  const Patch& patch;
  std::size_t lane;
};
// Those of the triangles in `mask` that neither their own plane nor that of `other` parts from it. `common`:
// what `other`'s patch has in common with this one, null for nothing. `error`: of every coordinate.
Mask16 not_parted(const PatchPlanes& planes, const Patch& patch, Mask16 mask, const PlaneOf& other,
                  const Common* common, float error);

}  // namespace cscd::fast
