#pragma once

#include "core/fast/keep_all/direction_cones.h"

namespace cscd::fast {

// A half-line from a viewpoint at the start of an interval, and which triangles it crosses.
class Ray {
 public:
  // Through the middle of a triangle, about. `error`: of every coordinate but the viewpoint's.
  Ray(const Viewpoint& viewpoint, const float (&through)[3], float error);

  // False is a proof that no triangle with such corners is crossed.
  bool may_cross(const PatchLanes& lanes) const;

  // Of triangles whose sign towards the viewpoint is positive: those that it certainly crosses inside, and
  // those that it certainly does not even touch.
  struct Crossed {
    Mask16 certainly, certainly_not;
  };
  Crossed crossed(const PatchLanes& lanes, const Patch& patch) const;

  bool outside(const Cone& cone) const;

 private:
  float from_[3];
  float across_[3], up_[3];  // the ray is where both vanish, along their cross product
  float along_[3];           // about that, of unit length
  float error_;              // of coordinates along `across_` and `up_`
};

}  // namespace cscd::fast
