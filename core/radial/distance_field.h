#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "core/base/vec3.h"
#include "core/mesh/triangle_mesh.h"

namespace cscd::radial {

// Returns the box of the triangles. Vertices that no triangle uses do not count.
inline Eigen::AlignedBox3d surface_box(const TriangleMesh& mesh, std::span<const Vec3> positions) {
  Eigen::AlignedBox3d box;
  for (const Triangle& t : mesh.triangles())
    for (const VertexId v : t) box.extend(positions[+v]);
  return box;
}

// Signed distance to a surface at the centres of the cells of a regular grid; negative inside.
struct DistanceField {
  Vec3 corner;  // lowest corner of the grid; the surface keeps one cell away from the grid's sides
  double cell;  // length of a cell's side
  std::array<int, 3> size;      // number of cells along x, y, z
  std::vector<float> distance;  // [z][y][x]; x runs fastest

  std::size_t index(int x, int y, int z) const {
    const auto i = static_cast<std::size_t>(x), j = static_cast<std::size_t>(y),
               k = static_cast<std::size_t>(z);
    return i + static_cast<std::size_t>(size[0]) * (j + static_cast<std::size_t>(size[1]) * k);
  }
  Vec3 centre(int x, int y, int z) const { return corner + cell * Vec3(x + 0.5, y + 0.5, z + 0.5); }
  // A bound on how far a point of a cell is from the cell's centre: half the diagonal, rounded up.
  double half_diagonal() const { return 0.8661 * cell; }
  // Returns the distance at the centre of the cell that holds the point. Off the grid it is positive and at
  // least one cell.
  double at(const Vec3& point) const;
};

// Makes the distance field of a surface whose positions are [vertices]. The grid has cubic cells,
// `cells_along_longest_side` of them along the longest side of the surface's box, and a margin. A grid of
// more than 2^25 cells is made coarser until it has at most that many.
//
// Within one cell of the surface, distances are exact but for rounding to float. Elsewhere they are off by at
// most half the diagonal of a cell. A point is inside if the surface winds round it, in whatever sense and
// however often. For an open surface the sign means little.
//
// Positions must be finite and of an order of magnitude that can be squared (segmentation.cpp scales them to
// size 1).
DistanceField make_distance_field(const TriangleMesh& mesh, std::span<const Vec3> positions,
                                  int cells_along_longest_side);

// Returns the number of cells along the longest side of the surface's box, at least 1, at which a cell is
// about as long as the mean edge. The papers call that "full resolution".
int resolution_of_mean_edge(const TriangleMesh& mesh, std::span<const Vec3> positions);

// Whether the segment stays inside as far as the grid can tell: no point of it is certainly outside.
bool runs_inside(const DistanceField& field, const Vec3& from, const Vec3& to);

}  // namespace cscd::radial
