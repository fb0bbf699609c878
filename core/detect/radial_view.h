#pragma once

#include <cstdint>
#include <vector>

namespace cscd {

// For pictures: how a radial strategy saw the surface in the last interval, triangle by triangle. Empty for
// strategies without observers.
struct RadialView {
  std::vector<std::int32_t> cluster;  // those with one label share an observer
  std::vector<bool> positive;         // certified to be seen from inside throughout
};

}  // namespace cscd
