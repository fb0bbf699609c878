#pragma once

#include <cstdint>
#include <vector>

namespace cscd {

// How a radial strategy saw the surface in the last interval, for pictures. Both vectors are empty
// for strategies without observers.
struct RadialView {
  std::vector<std::int32_t> cluster;  // [triangles]; triangles with the same label share an observer
  std::vector<bool> positive;         // [triangles]; certainly seen from inside throughout the interval
};

}  // namespace cscd
