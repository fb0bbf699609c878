#pragma once

#include <span>

#include "core/fast/cut/following_point.h"
#include "core/mesh/triangle_mesh.h"

namespace cscd::fast {

// Returns the observer of a cluster, given by its triangles, at least one: the point from which, in the
// reference pose, as much of the cluster as possible is seen from behind. It lies among the vertices of the
// cluster, or, where little of the cluster is seen from there, as of a sheet that is nearly flat, it stands
// off them. Observers of closed surfaces never stand off.
FollowingPoint observer_of(const TriangleMesh& mesh, std::span<const Vec3> reference,
                           std::span<const TriangleId> triangles);

}  // namespace cscd::fast
