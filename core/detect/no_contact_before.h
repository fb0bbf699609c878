#pragma once

#include <array>
#include <span>

#include "core/detect/culler.h"
#include "core/geometry/simd_floats.h"
#include "core/mesh/motion.h"
#include "core/mesh/triangle_mesh.h"

namespace cscd {

// Returns, for each of up to sixteen pairs of triangles, a time before which the two certainly do not touch,
// or do not come within a distance of each other: 0 where nothing is known, more than 1 where they never do.
// Along a direction, the gap between two triangles is at least what lies on the straight line between the
// gaps at both ends, so they do not touch before that line meets 0, and are farther apart until it meets the
// distance. The result is the latest such time over several directions: three axes, the normals of both
// triangles at both ends, and the way from one triangle to the other.
std::array<float, kLanes16> no_contact_before(const TriangleMesh& mesh, const Motion& motion,
                                              std::span<const TrianglePair> pairs, double distance = 0);

}  // namespace cscd
