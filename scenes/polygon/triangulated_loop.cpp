#include "scenes/polygon/triangulated_loop.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>
#include <CGAL/utility.h>
#include <algorithm>
#include <iterator>

namespace cscd::scenes {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

// Polygons with more corners are cut only by methods whose time is less than the cube of their number.
constexpr std::size_t kMostCornersCubed = 256;

}  // namespace

std::vector<std::array<std::size_t, 3>> triangulated_loop(std::span<const Vec3> loop, LoopKind kind) {
  std::vector<Kernel::Point_3> polyline;
  for (const Vec3& x : loop) polyline.emplace_back(x.x(), x.y(), x.z());
  std::vector<CGAL::Triple<int, int, int>> patch;
  if (kind == LoopKind::hole)
    CGAL::Polygon_mesh_processing::triangulate_hole_polyline(
        polyline, std::back_inserter(patch),
        CGAL::parameters::use_delaunay_triangulation(true).geom_traits(Kernel()));
  else
    CGAL::Polygon_mesh_processing::triangulate_hole_polyline(
        polyline, std::back_inserter(patch),
        CGAL::parameters::use_2d_constrained_delaunay_triangulation(true)
            .do_not_use_cubic_algorithm(loop.size() > kMostCornersCubed)
            .geom_traits(Kernel()));
  std::vector<std::array<std::size_t, 3>> triangles;
  if (patch.size() + 2 != loop.size()) return triangles;
  for (const auto& t : patch) {
    triangles.push_back({static_cast<std::size_t>(t.first), static_cast<std::size_t>(t.second),
                         static_cast<std::size_t>(t.third)});
    std::ranges::sort(triangles.back());
  }
  return triangles;
}

}  // namespace cscd::scenes
