#pragma once

#include "core/fast/contour/direction_cones.h"

namespace cscd::fast {

// A half-line from a viewpoint at the start of an interval. It tells which triangles it crosses.
class Ray {
 public:
  // Goes about through the point `through`, the middle of a triangle. `error` bounds the error of every
  // coordinate but the viewpoint's.
  Ray(const Viewpoint& viewpoint, const float (&through)[3], float error);

  // False is a proof that the ray crosses no triangle with such corners.
  bool may_cross(const PatchLanes& lanes) const;

  // For triangles that are positive towards the viewpoint: those that the ray certainly crosses in their
  // inside, and those that it certainly does not even touch.
  struct Crossed {
    Mask16 certainly, certainly_not;
  };
  Crossed crossed(const PatchLanes& lanes, const Patch& patch) const;

  // True is a proof that the direction of the ray lies outside the cone.
  bool outside(const Cone& cone) const;

 private:
  float from_[3];
  float across_[3], up_[3];  // the ray is where both products vanish, along their cross product
  float along_[3];           // about the direction of the ray, of unit length
  float error_;              // of coordinates along `across_` and `up_`
};

}  // namespace cscd::fast
