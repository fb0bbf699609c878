#pragma once

#include <span>
#include <vector>

#include "core/base/vec3.h"
#include "core/mesh/triangle_mesh.h"

namespace cscd::scenes {

// The triangles that close the holes of a mesh.
struct FilledHoles {
  std::vector<Triangle> triangles;  // to be added to the mesh
  std::size_t holes = 0;            // number of holes that are filled
  std::size_t left = 0;  // boundary loops left open: too long, not one clear loop, or refused by CGAL
};

// Closes the holes of up to `most_edges` edges by triangles between the vertices of the mesh, so that the
// new triangles move with the surface. Uses CGAL's triangulate_hole_polyline, which keeps the area of the
// triangles and the angles between neighbours small.
FilledHoles fill_holes(const TriangleMesh& mesh, std::span<const Vec3> positions, std::size_t most_edges);

}  // namespace cscd::scenes
