#pragma once

#include <span>
#include <vector>

#include "core/fast/cut/covers.h"
#include "core/fast/cut/patches.h"

namespace cscd::fast {

// Closes one loop of a cluster's contour: a fan of triangles about a point.
struct Cap {
  std::size_t cluster;
  FollowingPoint towards;  // the apex: this point, or one as far on the other side of the observer
  bool opposite;
  // Corners of at most sixteen triangles each; the last vertex stands for the apex. No triangles of the
  // mesh, no cover.
  std::vector<Patch> fans;
};

// Cluster and caps together have no boundary: every edge is passed as often in one direction as in the other.
std::vector<Cap> caps_of(const TriangleMesh& mesh, std::span<const Vec3> reference, const Cover& cover);

}  // namespace cscd::fast
