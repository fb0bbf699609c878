#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/base/vec3.h"
#include "core/mesh/triangle_mesh.h"

namespace cscd::scenes {

// How a .usda file is to be shown.
struct UsdStage {
  double fps = 30;
  std::string up = "y";  // the axis that points up (scenes/clip/up_axis.h)
  double metres_per_unit = 1;
};

// A .usda file of a moving surface: its points, colours and depths by time, points that mark contacts, and
// curves in which it crosses itself.
class UsdSurface {
 public:
  UsdSurface(std::span<const Triangle> triangles, UsdStage stage);

  // Adds the next frame, whose number is `frame`. `colour` names a colour of the palette for each triangle,
  // and `depth` is a number of each vertex; both are written where they change. `marks` and `curves` may be
  // empty.
  using Colour = std::array<float, 3>;
  void append(double frame, std::span<const Vec3> positions, std::span<const std::uint8_t> colour,
              std::span<const Colour> palette, std::span<const float> depth, std::span<const Vec3> marks,
              std::span<const std::vector<Vec3>> curves);
  // Marks are drawn as balls of this width, in lengths of the scene, and curves as lines of half the width.
  std::string text(double mark_width) const;

 private:
  // Samples of an array that seldom changes. A frame is written if its array is another than that of the
  // frame before, and then the frame before is written too: readers draw straight lines between samples, so a
  // sample long ago would begin to change at once.
  struct HeldSamples {
    void add(const std::string& time, std::string row);
    std::string rows, last_row, last_time, written_time;
  };

  UsdStage stage_;
  double first_frame_ = 0, last_frame_ = -1;
  HeldSamples colours_, depths_;
  std::string counts_, corners_, points_, extents_, marks_, curve_counts_, curve_points_;
};

}  // namespace cscd::scenes
