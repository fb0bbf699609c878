#pragma once

#include <span>

#include "core/mesh/triangle_mesh.h"

namespace cscd::fast {

struct Face {
  Vec3 centre, normal;  // the normal has unit length, or is zero if the triangle has no area
};
Face face_of(const TriangleMesh& mesh, std::span<const Vec3> positions, TriangleId triangle);

// Returns a point that lies behind as many of the faces as possible, with room to spare. Takes at least one
// face.
Vec3 best_viewpoint(std::span<const Face> faces);

}  // namespace cscd::fast
