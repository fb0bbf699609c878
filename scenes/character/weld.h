#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/vec3.h"
#include "core/mesh/triangle_mesh.h"

// Model files repeat a vertex wherever its normal, its texture or its material changes. For a surface, such
// vertices must be joined to one.
namespace cscd::scenes {

// Joins points that lie close together into groups, and returns for every point the smallest point index in
// its group. In ascending order, each point joins the first group whose smallest point lies within
// `tolerance` (a length of the scene, the bound included). So no chain of near points can draw a group out.
// A tolerance of zero joins equal points. The time is linear in the number of points as long as the
// tolerance is below their usual distance.
std::vector<std::int32_t> weld(std::span<const Vec3> positions, double tolerance);

// Splits groups by positions in another pose: the members that lie further than `tolerance` from the
// smallest point of their group leave it and are grouped by the rule of weld().
void split_groups(std::vector<std::int32_t>& group, std::span<const Vec3> positions, double tolerance);

// Returns the largest distance of a point to the smallest point of its group.
double largest_spread(std::span<const std::int32_t> group, std::span<const Vec3> positions);

// Three point indices.
using RawTriangle = std::array<std::int32_t, 3>;

// Triangles between groups of welded points.
struct WeldedTriangles {
  std::vector<Triangle> triangles;  // corners are the smallest points of their groups
  std::vector<std::size_t> source;  // [triangles]; index of the given triangle
  std::size_t collapsed = 0;        // number left out because two corners are in one group
  std::size_t duplicate = 0;        // number left out because the same three corners occur before
};
WeldedTriangles welded(std::span<const RawTriangle> triangles, std::span<const std::int32_t> group);

// Returns the number of edges that more than two triangles share.
std::size_t crowded_edges(std::span<const Triangle> triangles, std::size_t points);

}  // namespace cscd::scenes
