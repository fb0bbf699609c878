#pragma once

#include <span>
#include <vector>

#include "core/base/vec3.h"
#include "core/mesh/triangle_mesh.h"

namespace cscd::scenes {

struct FilledHoles {
  std::vector<Triangle> triangles;  // to be added
  std::size_t holes = 0;            // filled
  std::size_t left = 0;             // boundary loops that were not: too long, or not one loop, or refused
};

// Closes the holes of up to `most_edges` edges by triangles between the vertices that are there, so that they
// move with the surface (CGAL's triangulate_hole_polyline: least area and sharpest angles).
FilledHoles fill_holes(const TriangleMesh& mesh, std::span<const Vec3> positions, std::size_t most_edges);

}  // namespace cscd::scenes
