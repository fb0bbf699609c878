#pragma once

#include <span>

#include "core/mesh/triangle_mesh.h"

namespace cscd::fast {

struct Face {
  Vec3 centre, normal;  // the normal has unit length, or is zero
};
Face face_of(const TriangleMesh& mesh, std::span<const Vec3> positions, TriangleId triangle);

// Returns a point that lies behind as many of the faces as possible, with room to spare. There has to be at
// least one face. The more steps, the better the point.
Vec3 best_viewpoint(std::span<const Face> faces, int steps = 100);

}  // namespace cscd::fast
