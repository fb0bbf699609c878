#pragma once

#include <span>
#include <vector>

#include "core/fast/prepare/covers.h"
#include "core/fast/prepare/patches.h"

namespace cscd::fast {

// A cap closes one loop of a cluster's contour by a fan of triangles about a point, its apex.
struct Cap {
  FollowingPoint towards;  // the apex, or its mirror image in the observer if `opposite`
  bool opposite;
  // The triangles of the fan, at most sixteen in each patch. The last vertex of a patch stands for the apex.
  // These are no triangles of the mesh and belong to no cover.
  std::vector<Patch> fans;
};

// Builds caps of one cluster after the other.
class CapBuilder {
 public:
  // The mesh must outlive the builder.
  explicit CapBuilder(const TriangleMesh& mesh) : mesh_(mesh), passed_(mesh.edge_count()) {}

  // Returns the caps of a cluster, given by its triangles and its observer, built in a pose, `positions`
  // [vertices]. The cluster and its caps together have no boundary: every edge is passed as often in one
  // direction as in the other.
  std::vector<Cap> caps_of(std::span<const TriangleId> triangles, std::span<const Vec3> positions,
                           const FollowingPoint& observer);

 private:
  const TriangleMesh& mesh_;
  // [edges]: how much more often the triangles of the cluster go along an edge from its first end than from
  // its second. All zero between two calls.
  std::vector<std::int32_t> passed_;
  std::vector<EdgeId> contour_;
};

}  // namespace cscd::fast
