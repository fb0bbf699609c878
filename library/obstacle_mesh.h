#pragma once

#include <memory>
#include <vector>

#include "core/base/vec3.h"
#include "core/mesh/triangle_mesh.h"

#include "cscd/cscd.h"

namespace cscd {

// Obstacles as one mesh: the vertices of one obstacle follow those of the one before.
struct ObstacleMesh {
  std::vector<Vec3> positions;
  std::vector<std::size_t> first_vertex;
  TriangleMesh mesh;
};

// Returns null for no obstacles. Throws InputError for positions that are not finite and wrong corners.
std::unique_ptr<ObstacleMesh> obstacle_mesh_of(const std::vector<SelfCollision::Obstacle>& obstacles);

}  // namespace cscd
