#pragma once

#include <span>
#include <vector>

#include "core/fast/cut/covers.h"
#include "core/fast/cut/patches.h"

namespace cscd::fast {

// A *cap* closes one loop of a cluster's contour: a fan of triangles about a point, the apex, that follows
// the surface. The triangles of a cap belong to no mesh and no cover.
struct Cap {
  std::size_t cluster;
  FollowingPoint towards;  // the apex, or its mirror image
  bool opposite;           // the apex is the mirror image of `towards` in the observer
  // The triangles, in patches that belong to no cluster. The last place of a patch stands for the apex,
  // whatever vertex it names.
  std::vector<Patch> fans;
};

// Returns the caps of all clusters of a cover. A cluster and its caps together have no boundary: their
// triangles pass every edge as often in one direction as in the other. `reference`, [vertices], is the pose
// in which the apexes are chosen.
std::vector<Cap> caps_of(const TriangleMesh& mesh, std::span<const Vec3> reference, const Cover& cover);

}  // namespace cscd::fast
