#pragma once

#include <optional>
#include <span>

#include "core/fast/look/patch_lanes.h"

// Cones of directions in which a moving viewpoint sees something during an interval.
namespace cscd::fast {

// Half-angle less than a right angle, so that it is convex: what has its corners in it at both ends of the
// interval lies in it at every t, and the viewpoint is no point of it.
struct Cone {
  float axis[3];  // of unit length, up to rounding
  float cosine, sine;
};

// Cones of sixteen triangles. Lanes that are not known have none.
struct Cones {
  Float16 axis[3], cosine, sine;
  Mask16 known;

  Cone operator[](std::size_t lane) const {
    return {{axis[0][lane], axis[1][lane], axis[2][lane]}, cosine[lane], sine[lane]};
  }
};

// `error`: of every coordinate but the viewpoint's.
Cones cones_of(const PatchLanes& lanes, const Patch& patch, const Viewpoint& viewpoint, float error);

// One cone of the corners of all of them, at both ends; none where they are too far apart.
std::optional<Cone> cone_of(std::span<const PatchLanes> lanes, const Viewpoint& viewpoint, float error);

// Lanes whose cone certainly has no direction in common with the other.
Mask16 apart(const Cones& cones, const Cone& other);

}  // namespace cscd::fast
