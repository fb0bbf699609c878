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
// whatever the start. Signs alone keep the first contact of a mesh that starts embedded; the contour test
// keeps all contacts of any motion.
//
// Every loop of a cluster's contour is closed by a cap (caps.h), so that cluster and caps together are a
// closed surface S, as a chain. Let S never meet the observer; let S cross one ray from the observer once at
// t = 0, counted with signs; and let U be those triangles of S that are not certainly positive.
//
// Theorem. If triangles A and B of S meet in x at time t, and no triangle of U is seen in the direction of
// x, then x lies on a vertex or edge that A and B share.
// Proof. S goes round the observer equally often in every direction and at every time: once. Let a and b be
// the faces (vertex, edge or triangle) of A and B that hold x in their interior. All triangles at a are seen
// in the direction of x, so they are positive. As S is closed, the triangles at an edge lie on both sides of
// the edge equally often, and the triangles at a vertex go round the vertex, all one way. So the triangles at
// a cover every direction close to that of x at least once, and so do the triangles at b. Suppose that a is
// not b. Then no triangle is at both a and b, because that triangle would hold x in the interior of two of
// its faces. So those directions are covered at least twice, and no negative triangle takes from that count.
// But S covers them once. So a is b.
//
// (Triangles are counted as the mesh lists them: two triangles with the same corners count as two.)
//
// A positive triangle is *clear* if nothing of U is seen in any direction in which the triangle is seen. So a
// pair of triangles of one cluster carries no contact if one of the two is clear. This holds for any
// observers, covers and caps.
class CappedClusters {
 public:
  // For cover number `number`. `reference`, [vertices], is the pose in which its observers were placed.
  CappedClusters(const TriangleMesh& mesh, std::span<const Vec3> reference, const Cover& cover,
                 std::size_t number);

  // One interval: call `start`; then `take` for the patches that may matter, in any order; then `clear`. The
  // `viewpoints`, [clusters], are those of the cover's observers. They and the positions must stay in place
  // until the last call of the interval.
  void start(const LocalPositions& positions, std::span<const Viewpoint> viewpoints);
  // False is a proof that no triangle of the patch crosses its cluster's ray. Such a patch need not be taken
  // if all its triangles are positive.
  bool may_cross_ray(std::size_t cluster, const PatchLanes& lanes) const {
    return state_[cluster].ray->may_cross(lanes);
  }
  void take(const Patch& patch, Mask16 positive);
  // Returns the clear triangles among the positive triangles of a patch.
  Mask16 clear(const Patch& patch, Mask16 positive) const;

 private:
  struct State {  // of a cluster in this interval
    std::optional<Ray> ray;
    int crossings;                // of the ray with positive triangles
    bool known;                   // false: no triangle of the cluster is certainly clear
    std::vector<Cone> uncertain;  // cones that hold all directions of U

    void add(const Cone& cone) {
      uncertain.push_back(cone);
      known &= ray->outside(cone);
    }
  };
  void take(const Cap& cap);
  void take(const Patch& triangles, const PatchLanes& lanes, Mask16 positive, std::size_t cluster);

  std::size_t number_;
  std::vector<Cap> caps_;
  std::vector<Triangle> target_;  // [clusters]; the triangle that the cluster's ray goes through
  std::vector<State> state_;      // [clusters]
  std::vector<PatchLanes> loop_;  // [fans of a cap]; scratch
  std::vector<Mask16> positive_;  // [fans of a cap]; scratch
  const LocalPositions* positions_ = nullptr;
  std::span<const Viewpoint> viewpoints_;
};

}  // namespace cscd::fast
