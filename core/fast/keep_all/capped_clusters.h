#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/fast/keep_all/caps.h"
#include "core/fast/keep_all/direction_cones.h"
#include "core/fast/keep_all/ray.h"

namespace cscd::fast {

// The contour test of a cover: which of its triangles touch no other triangle of their cluster at any t,
// whatever the start. Signs alone keep the first contact of a mesh that starts embedded; this keeps all
// contacts of any motion.
//
// Every loop of a cluster's contour is capped by a fan about a point that follows it, so that cluster and
// caps together are a closed surface S, as a chain. Let S never meet the observer; let it cross one ray
// from the observer once at t = 0, counted with signs; and let U be those of its triangles that are not
// certainly positive.
//
// Theorem. If triangles A and B of S meet in x at time t, and no triangle of U is seen in the direction of
// x, then x lies on a vertex or edge that A and B share.
// Proof. How often S goes round the observer is the same in every direction and at every time: once. Let a
// and b be the faces (vertex, edge or triangle) of A and B that hold x inside. The triangles at a are seen
// in the direction of x, hence positive. As S is closed, those at an edge lie on both sides of it equally
// often, and those at a vertex go round it, all one way: so they cover every direction close to that of x at
// least once. So do those at b. If a is not b no triangle is at both, as it would hold x inside two of its
// faces. Then those directions are covered twice, and nothing negative takes from that. So a is b.
//
// (Triangles are counted as the mesh lists them: two with the same corners are two.)
//
// So a pair of triangles of one cluster carries no contact if one of both is clear: nothing of U is seen in
// any direction of its own. Observers of clusters, covers and caps may be any.
class CappedClusters {
 public:
  // Of cover `number`, in the pose in which observers were placed.
  CappedClusters(const TriangleMesh& mesh, std::span<const Vec3> reference, const Cover& cover,
                 std::size_t number);

  // One interval: `start`; then `take` patches that may matter, in any order; then ask.
  void start(const LocalPositions& positions, std::span<const Viewpoint> viewpoints);
  // Where false and all triangles of the patch are positive, the patch need not be taken.
  bool may_cross_ray(std::size_t cluster, const PatchLanes& lanes) const {
    return state_[cluster].ray->may_cross(lanes);
  }
  void take(const Patch& patch, Mask16 positive);
  // Of the positive triangles of a patch those that are clear.
  Mask16 clear(const Patch& patch, Mask16 positive) const;

 private:
  struct State {  // of a cluster in this interval
    std::optional<Ray> ray;
    int crossings;
    bool known;  // false: nothing is certain
    std::vector<Cone> uncertain;

    void add(const Cone& cone) {
      uncertain.push_back(cone);
      known &= ray->outside(cone);
    }
  };
  void take(const Cap& cap);
  void take(const Patch& triangles, const PatchLanes& lanes, Mask16 positive, std::size_t cluster);

  std::size_t number_;
  std::vector<Cap> caps_;
  std::vector<Triangle> target_;  // of each cluster: what its ray goes through
  std::vector<State> state_;
  std::vector<PatchLanes> loop_;  // of a cap
  std::vector<Mask16> positive_;  // triangles of it
  const LocalPositions* positions_ = nullptr;
  std::span<const Viewpoint> viewpoints_;
};

}  // namespace cscd::fast
