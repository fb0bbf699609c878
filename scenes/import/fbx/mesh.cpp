#include "scenes/import/fbx/mesh.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/error.h"
#include "core/base/vec3.h"
#include "scenes/polygon/cut_polygon.h"

namespace cscd::scenes::fbx {
namespace {

void add_polygon(std::span<const std::int32_t> corners, Mesh& mesh, const std::string& what) {
  switch (cut_polygon(corners, mesh.positions, mesh.triangles)) {
    case PolygonCut::good:
      return;
    case PolygonCut::overlapping:
      ++mesh.overlapping;
      return;
    case PolygonCut::none:
      throw InputError(what + ": its " + std::to_string(corners.size()) +
                       " corners cannot be cut into triangles; triangulate the mesh before the export");
  }
}

}  // namespace

std::vector<Vec3> read_points(const Element& element, std::size_t most, const std::string& what) {
  const std::vector<double> numbers = reals(element, 3 * most, what);
  if (numbers.size() % 3 != 0)
    throw InputError(what + ": has " + std::to_string(numbers.size()) +
                     " numbers, which are not three a vertex; repair it");
  std::vector<Vec3> points;
  points.reserve(numbers.size() / 3);
  for (std::size_t i = 0; i < numbers.size(); i += 3)
    points.emplace_back(numbers[i], numbers[i + 1], numbers[i + 2]);
  return points;
}

Mesh read_mesh(const Object& geometry, const CharacterLimits& limits) {
  const std::string where = told("mesh", geometry);
  Mesh mesh;
  if (const Element* vertices = geometry.element->child("Vertices"))
    mesh.positions = read_points(*vertices, limits.vertices, where + ", vertices");
  const Element* polygons = geometry.element->child("PolygonVertexIndex");
  if (polygons == nullptr) return mesh;

  std::vector<std::int32_t> corners;
  std::size_t polygon = 0;
  for (const std::int64_t written : integers(*polygons, 3 * limits.triangles, where + ", polygons")) {
    // The last corner of a polygon is written as its complement.
    const std::int64_t vertex = written < 0 ? -(written + 1) : written;
    const std::string what = where + ", polygon " + std::to_string(polygon);
    if (vertex >= static_cast<std::int64_t>(mesh.positions.size()))
      throw InputError(what + ": names vertex " + std::to_string(vertex) + " of " +
                       std::to_string(mesh.positions.size()) + "; repair it");
    corners.push_back(static_cast<std::int32_t>(vertex));
    if (written >= 0) continue;
    if (corners.size() < 3)
      ++mesh.lines;
    else
      add_polygon(corners, mesh, what);
    corners.clear();
    ++polygon;
  }
  if (!corners.empty())
    throw InputError(where + ", polygon " + std::to_string(polygon) + ": is cut short; export it again");
  return mesh;
}

}  // namespace cscd::scenes::fbx
