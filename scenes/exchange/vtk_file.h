#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/vec3.h"
#include "core/mesh/triangle_mesh.h"

// Files of VTK and ParaView: a .vtp file a moment, and a .pvd file that lists them.
namespace cscd::scenes {

// A .vtp file: points with triangles, or points that stand by themselves, and numbers on them.
class VtkSurface {
 public:
  VtkSurface(std::span<const Vec3> points,
             std::span<const Triangle> triangles);  // none: points by themselves

  // Numbers of each triangle, or of each point where there are no triangles; `width` numbers each.
  void add(const std::string& name, std::span<const float> values, std::size_t width = 1);
  std::string text() const;

 private:
  // Adds an array to the data behind the XML, and returns its element.
  template <class Value>
  std::string array(const std::string& attributes, std::span<const Value> values);

  bool by_themselves_;
  std::size_t points_count_, cells_count_;
  std::string points_, cells_, data_, appended_;
};

// A file that a .pvd file shows at a time.
struct VtkMoment {
  double time = 0;
  int part = 0;
  std::string file;  // beside the .pvd file
};
std::string to_pvd(std::span<const VtkMoment> moments);

}  // namespace cscd::scenes
