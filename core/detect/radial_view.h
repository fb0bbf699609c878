#pragma once

#include <cstdint>
#include <vector>

namespace cscd {

// How a radial strategy saw the surface in the last interval, [triangles], for pictures. Empty for strategies
// without observers.
struct RadialView {
  std::vector<std::int32_t> cluster;  // triangles with one label share an observer
  std::vector<bool> positive;         // certified to be seen from behind during the whole interval
};

}  // namespace cscd
