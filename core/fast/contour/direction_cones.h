#pragma once

#include <algorithm>
#include <optional>
#include <span>
#include <vector>

#include "core/fast/classify/patch_lanes.h"

// Cones of directions in which a moving viewpoint sees something during an interval.
namespace cscd::fast {

// A cone has a half-angle below a right angle, so it is convex: a triangle whose corners lie in the cone at
// both ends of the interval lies in it at every t. The viewpoint is then no point of the triangle.
struct Cone {
  float axis[3];       // of unit length, up to rounding
  float cosine, sine;  // of the half-angle
};

// The cones of sixteen triangles. A lane that is not known has no cone.
struct Cones {
  Float16 axis[3], cosine, sine;
  Mask16 known;

  Cone operator[](std::size_t lane) const {
    return {{axis[0][lane], axis[1][lane], axis[2][lane]}, cosine[lane], sine[lane]};
  }
};

// Returns the cones of a patch's triangles. `error` bounds the error of every coordinate but the viewpoint's.
Cones cones_of(const PatchLanes& lanes, const Patch& patch, const Viewpoint& viewpoint, float error);

// The same for quadrilaterals, each with the second and the third corner of a triangle in both sets of lanes.
Cones cones_of_strips(const PatchLanes& one, const PatchLanes& other, const Patch& patch,
                      const Viewpoint& viewpoint, float error);

// Returns one cone that holds all corners at both ends, or nothing where they are too far apart.
std::optional<Cone> cone_of(std::span<const PatchLanes> lanes, const Viewpoint& viewpoint, float error);

// Returns the lanes whose cone certainly has no direction in common with the other cone.
Mask16 apart(const Cones& cones, const Cone& other);

// A set of cones, sixteen of them side by side, so that one cone is held against sixteen at a time.
class ConeSet {
 public:
  void clear() { size_ = 0; }
  void add(const Cone& cone);
  std::size_t size() const { return size_; }

  // Calls take(cone) for every cone of the set that may have a direction in common with `other`. If `other`
  // is missing, these are all cones.
  template <class Take>
  void for_each_near(const std::optional<Cone>& other, const Take& take) const {
    for (std::size_t first = 0; first < size_; first += kLanes16) {
      const Cones& block = blocks_[first / kLanes16];
      const unsigned all = (1U << std::min(kLanes16, size_ - first)) - 1;
      for_each_lane(other ? all & ~static_cast<unsigned>(apart(block, *other)) : all,
                    [&](std::size_t lane) { take(block[lane]); });
    }
  }

 private:
  std::vector<Cones> blocks_;
  std::size_t size_ = 0;
};

}  // namespace cscd::fast
