#pragma once

#include <memory>
#include <span>

#include "core/mesh/triangle_mesh.h"

namespace cscd::fast {

// Returns the mesh with every component that faces inward turned round, or null if no component does. The
// numbers of triangles and vertices stay. Observers see a surface from behind, so a component that faces
// inward is seen well from nowhere. A closed component faces inward if its volume is negative, an open one
// if it encloses a point, as half a ball does, and most of it faces that point.
//
// No theorem of core/soundness.md asks which side of a component is the outside: turning a whole component
// round makes positive triangles negative and negative ones positive, and the contour test takes any surface.
std::unique_ptr<const TriangleMesh> turned_outward(const TriangleMesh& mesh, std::span<const Vec3> reference);

}  // namespace cscd::fast
