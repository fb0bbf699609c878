#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/base/vec3.h"
#include "core/detect/exclusions.h"
#include "core/mesh/triangle_mesh.h"

#include "cscd/cscd.h"

namespace cscd {

// What a caller leaves out, for the engine. Throws InputError for what does not fit the mesh.
Exclusions exclusions_of(const TriangleMesh& mesh, std::span<const Vec3> reference,
                         const SelfCollision::Exclusions& asked);

// Obstacles as one mesh: the vertices of one obstacle follow those of the one before.
struct ObstacleMesh {
  std::vector<Vec3> positions;
  std::vector<std::size_t> first_vertex;
  TriangleMesh mesh;
};

// Returns null for no obstacles. Throws InputError for positions that are not finite and wrong corners.
std::unique_ptr<ObstacleMesh> obstacle_mesh_of(const std::vector<SelfCollision::Obstacle>& obstacles);

}  // namespace cscd
