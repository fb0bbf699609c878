#pragma once

#include <span>

#include "core/base/vec3.h"
#include "core/detect/exclusions.h"
#include "core/mesh/triangle_mesh.h"

#include "cscd/cscd.h"

namespace cscd {

// What a caller leaves out, for the engine. Throws InputError for what does not fit the mesh.
Exclusions exclusions_of(const TriangleMesh& mesh, std::span<const Vec3> reference,
                         const SelfCollision::Exclusions& asked);

}  // namespace cscd
