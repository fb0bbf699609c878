#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/vec3.h"
#include "core/mesh/triangle_mesh.h"

// Model files repeat a vertex wherever its normal, its texture or its material changes. For a surface such
// vertices must be one.
namespace cscd::scenes {

// For every point the smallest point of its group: each joins the first group whose smallest point lies
// within `tolerance` (both ends included), so no chain of near points can draw a group out. Zero joins equal
// points. Linear in the points for tolerances under their usual distance.
std::vector<std::int32_t> weld(std::span<const Vec3> positions, double tolerance);

// Splits the groups whose members are further apart than `tolerance` in another pose, by the same rule.
void split_groups(std::vector<std::int32_t>& group, std::span<const Vec3> positions, double tolerance);

// The largest distance of a point to the smallest point of its group.
double largest_spread(std::span<const std::int32_t> group, std::span<const Vec3> positions);

using RawTriangle = std::array<std::int32_t, 3>;

// Triangles between groups.
struct WeldedTriangles {
  std::vector<Triangle> triangles;  // corners are smallest points of groups
  std::vector<std::size_t> source;  // of each triangle, which of the given ones it is
  std::size_t collapsed = 0;        // left out: two corners in one group
  std::size_t duplicate = 0;        // left out: the same three corners again
};
WeldedTriangles welded(std::span<const RawTriangle> triangles, std::span<const std::int32_t> group);

// Edges with more than two triangles.
std::size_t crowded_edges(std::span<const Triangle> triangles, std::size_t points);

}  // namespace cscd::scenes
