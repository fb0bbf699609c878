#pragma once

#include <optional>
#include <span>

#include "core/fast/look/patch_lanes.h"

// Cones of directions in which a moving viewpoint sees something during an interval.
namespace cscd::fast {

// A cone of directions. Its half-angle is less than a right angle, so the cone is convex: a triangle whose
// corners are seen in the cone at both ends of the interval is seen in the cone at every t, and never
// contains the viewpoint.
struct Cone {
  float axis[3];       // of unit length, up to rounding
  float cosine, sine;  // of the half-angle
};

// The cones of sixteen triangles, one a lane. A lane that is not `known` has no cone.
struct Cones {
  Float16 axis[3], cosine, sine;
  Mask16 known;

  Cone operator[](std::size_t lane) const {
    return {{axis[0][lane], axis[1][lane], axis[2][lane]}, cosine[lane], sine[lane]};
  }
};

// Returns the cones in which the triangles of a patch are seen. `error` is the error of every coordinate but
// the viewpoint's, which is exact.
Cones cones_of(const PatchLanes& lanes, const Patch& patch, const Viewpoint& viewpoint, float error);

// Returns one cone in which all these vertices are seen at both ends. Returns nothing if their directions are
// too far apart for one cone.
std::optional<Cone> cone_of(std::span<const PatchLanes> lanes, const Viewpoint& viewpoint, float error);

// Returns the lanes whose cone certainly has no direction in common with `other`.
Mask16 apart(const Cones& cones, const Cone& other);

}  // namespace cscd::fast
