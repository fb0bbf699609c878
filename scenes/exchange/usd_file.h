#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/base/vec3.h"
#include "core/mesh/triangle_mesh.h"

namespace cscd::scenes {

// A .usda file of a moving surface: its points, colours and depths by time, points that mark contacts, and
// curves in which it crosses itself.
class UsdSurface {
 public:
  UsdSurface(std::span<const Triangle> triangles, double fps);

  // Adds the next frame. `colour` names a colour of the palette for each triangle, and `depth` is a number of
  // each vertex; both are written where they differ from those of the frame before. `marks` and `curves` may
  // be empty.
  using Colour = std::array<float, 3>;
  void append(std::span<const Vec3> positions, std::span<const std::uint8_t> colour,
              std::span<const Colour> palette, std::span<const float> depth, std::span<const Vec3> marks,
              std::span<const std::vector<Vec3>> curves);
  // Marks are drawn as balls of this width, in lengths of the scene, and curves as lines of half the width.
  std::string text(double mark_width) const;

 private:
  double fps_;
  std::size_t frames_ = 0;
  std::vector<std::uint8_t> last_colour_;
  std::vector<float> last_depth_;
  std::string counts_, corners_, points_, extents_, colours_, depths_, marks_, curve_counts_, curve_points_;
};

}  // namespace cscd::scenes
