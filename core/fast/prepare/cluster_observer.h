#pragma once

#include <span>

#include "core/fast/prepare/following_point.h"
#include "core/mesh/triangle_mesh.h"

namespace cscd::fast {

// Returns the observer of a cluster, given by its triangles, at least one: the point from which, in the
// reference pose, as much of the cluster as possible is seen from behind. It lies among the vertices of the
// cluster, or, where little of the cluster is seen from there, as of a sheet that is nearly flat, it stands
// off them. Observers of closed surfaces never stand off.
FollowingPoint observer_of(const TriangleMesh& mesh, std::span<const Vec3> reference,
                           std::span<const TriangleId> triangles);

// What a search found in a hurry: an observer, and the share of the triangles that it sees.
struct Sight {
  FollowingPoint from;
  double seen = 0;
};
// Looks for an observer of a cluster while intervals are answered. Takes some tens of microseconds: it looks
// at few of the triangles, spread over all of them, and in few places. The observer may stand off closed
// surfaces too.
Sight brief_sight_of(const TriangleMesh& mesh, std::span<const Vec3> positions,
                     std::span<const TriangleId> triangles);
// Returns the share of the same triangles that another observer sees.
double brief_share_seen(const TriangleMesh& mesh, std::span<const Vec3> positions,
                        std::span<const TriangleId> triangles, const FollowingPoint& from);

}  // namespace cscd::fast
