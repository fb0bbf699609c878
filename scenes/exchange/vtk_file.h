#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/vec3.h"
#include "core/mesh/triangle_mesh.h"

// Files of VTK and ParaView: a .vtp file a moment, and a .pvd file that lists them.
namespace cscd::scenes {

// A .vtp file: points with triangles, points that stand by themselves, or polylines, and numbers on them.
class VtkSurface {
 public:
  VtkSurface(std::span<const Vec3> points,
             std::span<const Triangle> triangles);  // none: points by themselves
  explicit VtkSurface(std::span<const std::vector<Vec3>> polylines);

  // Numbers of each triangle or polyline, or of each point where points stand by themselves; `width` numbers
  // each.
  void add(const std::string& name, std::span<const float> values, std::size_t width = 1);
  // Numbers of each point of triangles or polylines.
  void add_to_points(const std::string& name, std::span<const float> values);
  std::string text() const;

 private:
  // Adds an array to the data behind the XML, and returns its element.
  template <class Value>
  std::string array(const std::string& attributes, std::span<const Value> values);

  void set_cells(const char* kind, std::span<const Vec3> points, std::span<const std::int64_t> corners,
                 std::span<const std::int64_t> ends);

  std::string kind_;  // of the cells, as VTK calls it
  std::size_t points_count_ = 0, cells_count_ = 0;
  std::string points_, cells_, data_, point_data_, appended_;
};

// A file that a .pvd file shows at a time.
struct VtkMoment {
  double time = 0;
  int part = 0;
  std::string file;  // beside the .pvd file
};
std::string to_pvd(std::span<const VtkMoment> moments);

}  // namespace cscd::scenes
