#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/fast/contour/caps.h"
#include "core/fast/contour/direction_cones.h"
#include "core/fast/contour/ray.h"

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

  // Makes it `count` clusters from the next interval on. A new one has to be cut before that.
  void resize(std::size_t count);
  // Gives the last cluster the number of another one.
  void rename_last(std::size_t cluster);
  // Gives a cluster other triangles and another observer, placed in the pose `positions`. Rays will go
  // through some of `targets`.
  void set_cluster(std::size_t cluster, CapBuilder& builder, const TriangleMesh& mesh,
                   std::span<const TriangleId> triangles, std::span<const TriangleId> targets,
                   std::span<const Vec3> positions, const FollowingPoint& observer);

  // An interval is one call of `start`, which the pool shares, then one call of `take` for each patch that
  // may matter, in any order. Then, while choose_other_rays() returns true, one call of `count` for each
  // patch of the clusters that have another ray. Then follows any number of questions.
  void start(const LocalPositions& positions, std::span<const Viewpoint> viewpoints,
             const ThreadPool& pool = ThreadPool());
  // A patch whose triangles are all positive need not be taken if this is false.
  bool may_cross_ray(std::size_t cluster, const PatchLanes& lanes) const {
    return state_[cluster].ray->may_cross(lanes);
  }
  void take(const Patch& patch, Mask16 positive);
  // A ray decides nothing if a triangle of U may be seen in its direction, or if it passes too near to an
  // edge to be counted. Another ray through the same cluster often does better.
  bool choose_other_rays();
  bool has_other_ray(std::size_t cluster) const { return state_[cluster].has_other_ray; }
  void count(const Patch& patch, Mask16 positive);

  // Whether all triangles of the cluster are positive and clear.
  bool all_clear(std::size_t cluster) const {
    return state_[cluster].known() && state_[cluster].uncertain.size() == 0;
  }
  // Returns the clear ones among the positive triangles of a patch.
  Mask16 clear(const Patch& patch, Mask16 positive) const;

 private:
  static constexpr std::size_t kRays = 8;  // the largest number of rays that an interval tries for a cluster

  struct State {  // what is known of a cluster in this interval
    std::optional<Ray> ray;
    std::size_t rays = 1;  // that were tried
    int crossings = 0;
    bool ray_decides = true;  // whether `crossings` is certain and no triangle of U is seen along the ray
    bool has_other_ray = false;
    bool cones_known = true;  // whether `uncertain` holds all of U
    ConeSet uncertain;        // the cones of U

    bool known() const { return cones_known && ray_decides && crossings == 1; }
    void add(const Cone& cone) {
      uncertain.add(cone);
      ray_decides &= ray->outside(cone);
    }
    void count(const Patch& triangles, const PatchLanes& lanes, Mask16 positive);
  };
  struct CapOrientation {          // at a cap
    std::vector<PatchLanes> loop;  // in registers
    std::vector<Mask16> positive;  // the positive triangles
  };
  Ray ray_through(std::size_t cluster, const Triangle& target) const;
  void start(std::size_t cluster, CapOrientation& at_cap);
  void classify(const Cap& cap, std::size_t cluster, CapOrientation& at_cap) const;
  void take(const Cap& cap, std::size_t cluster, CapOrientation& at_cap);
  void take_in_slices(const Patch& fan, const PatchLanes& lanes, unsigned triangles, std::size_t cluster);
  void add_cones(unsigned triangles, const Cones& cones, State& state);
  void take(const Patch& triangles, const PatchLanes& lanes, Mask16 positive, std::size_t cluster);

  std::size_t number_;
  std::vector<std::vector<Cap>> caps_;  // [clusters]
  // [clusters]: the triangles that a ray of the cluster may go through, the best one first
  std::vector<std::vector<Triangle>> targets_;
  std::vector<State> state_;
  std::vector<CapOrientation> at_cap_;  // [ranges of clusters]: room for the cap that a thread classifies
  const LocalPositions* positions_ = nullptr;
  std::span<const Viewpoint> viewpoints_;
};

}  // namespace cscd::fast
