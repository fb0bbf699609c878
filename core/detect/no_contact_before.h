#pragma once

#include <array>
#include <span>

#include "core/detect/culler.h"
#include "core/geometry/lanes16.h"
#include "core/mesh/motion.h"
#include "core/mesh/triangle_mesh.h"

namespace cscd {

// Returns, for up to sixteen pairs of triangles, a time before which the two certainly do not touch: 0 if
// nothing is known, more than 1 if they never touch in the interval. Lanes without a pair hold no meaning.
//
// Along a fixed direction, the gap between the two triangles is at least the linear interpolation of the gaps
// at both ends of the interval. So the triangles are apart until that line reaches 0. The result is the
// latest such time over these directions: the three axes, the normals of both triangles at both ends, and the
// direction from one triangle to the other.
std::array<float, kLanes16> no_contact_before(const TriangleMesh& mesh, const Motion& motion,
                                              std::span<const TrianglePair> pairs);

}  // namespace cscd
