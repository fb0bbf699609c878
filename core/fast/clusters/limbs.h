#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/fast/clusters/triangle_paths.h"

namespace cscd::fast {

// A part of a surface that sticks out and is long for its girth, such as a finger or a tentacle. A surface
// without branches, such as a rope, is one limb. The lines of equal `along` go round the limb.
struct Limb {
  std::vector<TriangleId> triangles;
  std::vector<double> along;  // [triangles]: grows from the limb's root to its tip

  double lowest() const;
  double length() const;
};

// A connected component of a surface, divided into its limbs and what they stick out from, the hub.
struct Body {
  std::vector<Limb> limbs;
  std::vector<TriangleId> hub;  // empty where the component is one limb
};

// Divides a connected component into limbs and a hub. `component` holds its triangles. `piece` and `area` are
// [triangles of the mesh]: the component of each triangle, and its area. A limb reaches into the hub by about
// its own radius, because that is where limbs bend. Uses the paths as scratch memory.
Body body_of(TrianglePaths& paths, std::span<const double> area, std::span<const std::int32_t> piece,
             std::span<const TriangleId> component);

}  // namespace cscd::fast
