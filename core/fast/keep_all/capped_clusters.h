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
// whatever the start. Signs alone keep the first contact of a mesh that starts embedded; this test keeps all
// contacts of any motion.
//
// Every loop of a cluster's contour is capped by a fan about a point that follows the loop, so that cluster
// and caps together are a closed surface S, as a chain. Let S never meet the observer; let S cross one ray
// from the observer once at t = 0, counted with signs; and let U be the triangles of S that are not certainly
// positive.
//
// Theorem. If triangles A and B of S meet in x at time t, and no triangle of U is seen in the direction of x,
// then x lies on a vertex or edge that A and B share. Proof: core/soundness.md.
// (Triangles are counted as the mesh lists them: two with the same corners are two.)
//
// So a pair of triangles of one cluster carries no contact if one of the two is clear: nothing of U is seen
// in any direction in which the triangle is seen. Observers of clusters, covers and caps may be any.
class CappedClusters {
 public:
  // Caps the clusters of cover `number`. `reference` is the pose in which the observers were placed.
  CappedClusters(const TriangleMesh& mesh, std::span<const Vec3> reference, const Cover& cover,
                 std::size_t number);

  // An interval is one call of `start`, then one call of `take` for each patch that may matter, in any order,
  // then any number of questions.
  void start(const LocalPositions& positions, std::span<const Viewpoint> viewpoints);
  // A patch whose triangles are all positive need not be taken if this is false.
  bool may_cross_ray(std::size_t cluster, const PatchLanes& lanes) const {
    return state_[cluster].ray->may_cross(lanes);
  }
  void take(const Patch& patch, Mask16 positive);
  // Returns the clear ones among the positive triangles of a patch.
  Mask16 clear(const Patch& patch, Mask16 positive) const;

 private:
  struct State {  // what is known of a cluster in this interval
    std::optional<Ray> ray;
    int crossings;
    bool known;  // if false, nothing is certain of the cluster
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
  std::vector<Triangle> target_;  // [clusters]: the triangle that the cluster's ray goes through
  std::vector<State> state_;
  std::vector<PatchLanes> loop_;  // the loop of a cap, in registers
  std::vector<Mask16> positive_;  // the positive triangles of that cap
  const LocalPositions* positions_ = nullptr;
  std::span<const Viewpoint> viewpoints_;
};

}  // namespace cscd::fast
