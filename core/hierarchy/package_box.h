#pragma once

#include <algorithm>

#include "core/hierarchy/bounds.h"

namespace cscd {

// A box for a package that cannot handle coordinates beyond `farthest` and would lose the box: all
// coordinates are clamped to [-farthest, farthest]. Boxes that overlap still do so when both are clamped.
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
