#pragma once

#include "core/fast/keep_all/direction_cones.h"

namespace cscd::fast {

// A half-line from a viewpoint at the start of an interval, and tests of which triangles it crosses.
class Ray {
 public:
  // The ray goes from the viewpoint roughly through the point `through`; which points it goes through exactly
  // does not matter. `error` is the error of every coordinate but the viewpoint's, which is exact.
  Ray(const Viewpoint& viewpoint, const float (&through)[3], float error);

  // False is a proof that the ray crosses no triangle whose corners are among these vertices.
  bool may_cross(const PatchLanes& lanes) const;

  // How the ray meets those triangles of a patch that are positive towards the viewpoint: which of them it
  // certainly crosses in their interior, and which of them it certainly does not even touch. Says nothing of
  // other triangles.
  struct Crossed {
    Mask16 certainly, certainly_not;
  };
  Crossed crossed(const PatchLanes& lanes, const Patch& patch) const;

  // True is a proof that the direction of the ray lies outside the cone.
  bool outside(const Cone& cone) const;

 private:
  float from_[3];
  float across_[3], up_[3];  // the ray's exact direction is their cross product
  float along_[3];           // that direction up to rounding, of unit length
  float error_;              // of coordinates along `across_` and `up_`
};

}  // namespace cscd::fast
