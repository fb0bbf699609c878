#pragma once

#include <span>

#include "core/mesh/triangle_mesh.h"

namespace cscd::fast {

struct Face {
  Vec3 centre, normal;  // of unit length, or zero
};
Face face_of(const TriangleMesh& mesh, std::span<const Vec3> positions, TriangleId triangle);

// A point behind as many faces as possible, with room to spare. Takes at least one.
Vec3 best_viewpoint(std::span<const Face> faces);

}  // namespace cscd::fast
