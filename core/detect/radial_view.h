#pragma once

#include <cstdint>
#include <vector>

#include "core/mesh/motion.h"

namespace cscd {

// How a radial strategy saw the surface in the last interval, for pictures. Empty for strategies without
// observers.
struct RadialView {
  // An observer is a point, whose head and tail are equal, or the segment from head to tail. Both move in
  // straight lines during the interval.
  struct Observer {
    std::int32_t cluster;  // the label of the triangles that it looks at
    MovingPoint head, tail;
  };
  std::vector<std::int32_t> cluster;  // [triangles]; triangles with one label share an observer
  std::vector<bool> positive;         // [triangles]; certified to be seen from behind in the whole interval
  std::vector<Observer> observers = {};  // of all labels

  // A further cover of `drvbc_fast` (core/fast/README.md), whose clusters are the same in every interval.
  struct Cover {
    std::vector<std::int32_t> cluster;  // [triangles]; -1 for a triangle that the cover leaves out
    std::vector<Observer> observers;
  };
  std::vector<Cover> further_covers = {};  // the covers in use behind the first one
  // [triangles]: the patch of each triangle, the same in every interval.
  std::vector<std::int32_t> patch = {};
};

}  // namespace cscd
