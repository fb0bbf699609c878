#pragma once

#include <array>
#include <span>

#include "core/detect/culler.h"
#include "core/geometry/lanes16.h"
#include "core/mesh/motion.h"
#include "core/mesh/triangle_mesh.h"

namespace cscd {

// Of up to sixteen pairs of triangles, a time before which the two certainly do not touch: 0 where nothing is
// known, more than 1 where they never do. Along a direction, the gap between them is at least what lies on
// the straight line between the gaps at both ends. So it is the latest time at which one of these lines meets
// 0, of three axes, the normals of both triangles at both ends, and the way from one to the other.
std::array<float, kLanes16> no_contact_before(const TriangleMesh& mesh, const Motion& motion,
                                              std::span<const TrianglePair> pairs);

}  // namespace cscd
