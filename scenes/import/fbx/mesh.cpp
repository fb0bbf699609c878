#include "scenes/import/fbx/mesh.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/error.h"
#include "core/base/vec3.h"
#include "scenes/import/fbx/triangulated_loop.h"

namespace cscd::scenes::fbx {
namespace {

// Where the diagonals' lengths are equal up to rounding, the diagonal from the first corner is chosen, as
// most programs do.
constexpr double kEqualLengths = 1e-9;

void cut_quadrilateral(std::span<const std::int32_t> c, std::span<const Vec3> positions,
                       std::vector<std::array<std::int32_t, 3>>& triangles) {
  const auto at = [&](std::size_t k) -> const Vec3& { return positions[static_cast<std::size_t>(c[k % 4])]; };
  const Vec3 first = at(2) - at(0), second = at(3) - at(1), normal = first.cross(second);
  // The diagonal from corner k lies inside if both triangles beside it turn as the whole quadrilateral does.
  const auto inside = [&](std::size_t k) {
    const Vec3 one = (at(k + 1) - at(k)).cross(at(k + 2) - at(k)),
               other = (at(k + 2) - at(k)).cross(at(k + 3) - at(k));
    return one.dot(normal) > 0 && other.dot(normal) > 0;
  };
  const bool first_inside = inside(0), second_inside = inside(1);
  const bool first_shorter = first.squaredNorm() <= second.squaredNorm() * (1 + kEqualLengths);
  if (first_inside == second_inside ? first_shorter : first_inside) {
    triangles.push_back({c[0], c[1], c[2]});
    triangles.push_back({c[0], c[2], c[3]});
  } else {
    triangles.push_back({c[0], c[1], c[3]});
    triangles.push_back({c[1], c[2], c[3]});
  }
}

// Cuts off, by triangles without extent, the corners that lie where the corner before them lies. Such
// corners would turn one edge that a polygon runs along twice into two edges.
std::vector<std::int32_t> without_repeats(std::span<const std::int32_t> corners,
                                          std::span<const Vec3> positions,
                                          std::vector<std::array<std::int32_t, 3>>& triangles) {
  const auto same = [&](std::int32_t a, std::int32_t b) {
    return positions[static_cast<std::size_t>(a)] == positions[static_cast<std::size_t>(b)];
  };
  std::vector<std::int32_t> kept{corners.front()};
  std::size_t left = corners.size();
  for (std::size_t k = 1; k < corners.size(); ++k) {
    if (left > 3 && same(kept.back(), corners[k])) {
      triangles.push_back({kept.back(), corners[k], k + 1 < corners.size() ? corners[k + 1] : kept.front()});
      --left;
    } else {
      kept.push_back(corners[k]);
    }
  }
  while (kept.size() > 3 && same(kept.back(), kept.front())) {
    triangles.push_back({kept[kept.size() - 2], kept.back(), kept.front()});
    kept.pop_back();
  }
  return kept;
}

// Tells whether a polygon encloses no area, so that all ways to cut it are equally good.
bool has_no_area(std::span<const std::int32_t> corners, std::span<const Vec3> positions) {
  constexpr double kNothing = 1e-14;
  const Vec3& start = positions[static_cast<std::size_t>(corners.front())];
  Vec3 doubled = Vec3::Zero();
  double length = 0;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const Vec3& a = positions[static_cast<std::size_t>(corners[k])];
    const Vec3& b = positions[static_cast<std::size_t>(corners[(k + 1) % corners.size()])];
    doubled += (a - start).cross(b - start);
    length += (b - a).norm();
  }
  return doubled.norm() <= kNothing * length * length;
}

bool cut_polygon(std::span<const std::int32_t> corners, std::span<const Vec3> positions,
                 std::vector<std::array<std::int32_t, 3>>& triangles) {
  std::vector<Vec3> loop;
  for (const std::int32_t corner : corners) {
    loop.push_back(positions[static_cast<std::size_t>(corner)]);
    if (!loop.back().allFinite()) return false;
  }
  const auto cut = triangulated_loop(loop, LoopKind::polygon);
  for (const auto& [a, b, c] : cut) triangles.push_back({corners[a], corners[b], corners[c]});
  return !cut.empty();
}

// Adds the triangles of a polygon to `triangles`. The polygon may be concave and need not be flat. A
// quadrilateral is cut along a diagonal that lies inside, and along the shorter one where both do. Returns
// false if there is no good way to cut the polygon.
bool triangulate(std::span<const std::int32_t> corners, std::span<const Vec3> positions,
                 std::vector<std::array<std::int32_t, 3>>& triangles) {
  if (corners.size() == 3) {
    triangles.push_back({corners[0], corners[1], corners[2]});
    return true;
  }
  if (corners.size() == 4) {
    cut_quadrilateral(corners, positions, triangles);
    return true;
  }
  const std::vector<std::int32_t> kept = without_repeats(corners, positions, triangles);
  if (kept.size() < corners.size()) return triangulate(kept, positions, triangles);
  if (has_no_area(corners, positions)) {
    for (std::size_t k = 2; k < corners.size(); ++k)
      triangles.push_back({corners[0], corners[k - 1], corners[k]});
    return true;
  }
  return cut_polygon(corners, positions, triangles);
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
    else if (!triangulate(corners, mesh.positions, mesh.triangles))
      throw InputError(what + ": its " + std::to_string(corners.size()) +
                       " corners cannot be cut into triangles; triangulate the mesh before the export");
    corners.clear();
    ++polygon;
  }
  if (!corners.empty())
    throw InputError(where + ", polygon " + std::to_string(polygon) + ": is cut short; export it again");
  return mesh;
}

}  // namespace cscd::scenes::fbx
