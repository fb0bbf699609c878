#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/base/vec3.h"
#include "core/mesh/triangle_mesh.h"

namespace cscd::scenes {

// A .usda file of a moving surface: its points and colours by time, and points that mark contacts.
class UsdSurface {
 public:
  UsdSurface(std::span<const Triangle> triangles, double fps);

  // Adds the next frame. `colour` names a colour of the palette for each triangle; it is written where it
  // differs from that of the frame before. `marks` may be empty.
  using Colour = std::array<float, 3>;
  void append(std::span<const Vec3> positions, std::span<const std::uint8_t> colour,
              std::span<const Colour> palette, std::span<const Vec3> marks);
  // Marks are drawn as balls of this width, in lengths of the scene.
  std::string text(double mark_width) const;

 private:
  double fps_;
  std::size_t frames_ = 0;
  std::vector<std::uint8_t> last_colour_;
  std::string counts_, corners_, points_, extents_, colours_, marks_;
};

}  // namespace cscd::scenes
