#pragma once

#include <algorithm>

#include "core/hierarchy/bounds.h"

namespace cscd {

// Returns the box cut off at `farthest`, beyond which packages lose it. Boxes that overlap still overlap when
// they are cut off there.
struct PackageBox {
  float low[3], high[3];

  PackageBox(const Aabb& box, float farthest) {
    for (std::size_t k = 0; k < 3; ++k) {
      low[k] = std::clamp(box.at_least[k], -farthest, farthest);
      high[k] = std::clamp(-box.at_least[Aabb::kDirections + k], -farthest, farthest);
    }
  }
};

}  // namespace cscd
