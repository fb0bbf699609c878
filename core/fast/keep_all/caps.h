#pragma once

#include <span>
#include <vector>

#include "core/fast/cut/covers.h"
#include "core/fast/cut/patches.h"

namespace cscd::fast {

// A cap closes one loop of a cluster's contour by a fan of triangles about a point, its apex.
struct Cap {
  std::size_t cluster;
  FollowingPoint towards;  // the apex, or its mirror image in the observer if `opposite`
  bool opposite;
  // The triangles of the fan, at most sixteen in each patch. The last vertex of a patch stands for the apex.
  // These are no triangles of the mesh and belong to no cover.
  std::vector<Patch> fans;
};

// Returns the caps of all clusters of a cover, built in the reference pose. A cluster and its caps together
// have no boundary: every edge is passed as often in one direction as in the other.
std::vector<Cap> caps_of(const TriangleMesh& mesh, std::span<const Vec3> reference, const Cover& cover);

}  // namespace cscd::fast
