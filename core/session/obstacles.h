#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "core/detect/detector.h"
#include "core/detect/exclusions.h"
#include "core/detect/start/embedding.h"
#include "core/hierarchy/bounds.h"
#include "core/hierarchy/tree.h"
#include "core/session/candidates.h"

namespace cscd {

// Holds a deforming surface against surfaces beside it, the obstacles. An obstacle is at rest, or it moves as
// the caller says. Obstacles are never held against each other or against themselves. The bounds of obstacles
// are computed only where some of them move, so obstacles at rest cost next to nothing until one of
// their triangles comes into the box of the deforming surface.
class Obstacles {
 public:
  // `own` is the deforming surface, and `reference`, [its vertices], any pose of it. `beside` holds the
  // triangles of all obstacles, whose vertices are numbered from 0, and `positions` says where these are at
  // rest. `first_vertex` holds the first vertex of each obstacle. The elementary test must
  // outlive the object.
  Obstacles(const TriangleMesh& own, std::span<const Vec3> reference, const TriangleMesh& beside,
            std::span<const Vec3> positions, std::vector<std::size_t> first_vertex,
            const ElementaryTest& elementary);
  ~Obstacles();

  // All surfaces as one mesh: vertices and triangles of obstacles are numbered behind those of the deforming
  // surface. Feature pairs and crossings that are found refer to this mesh.
  const TriangleMesh& together() const { return together_; }

  // Leaves out what the exclusions name, which refer to together() and must outlive the object.
  void leave_out(const Exclusions& exclusions);
  // Counts close pairs as contacts from the next step on. The thickness is about together(), and what it
  // refers to must outlive the object.
  void thicken(const Thickness& thickness) { thickness_ = thickness; }

  // The number of vertices of one obstacle.
  std::size_t vertex_count(std::size_t obstacle) const;
  // From the next step on, one obstacle moves from `start` to `end` in each step, [its vertices] each. Where
  // both are the same it is at rest. Positions have to be finite.
  void move(std::size_t obstacle, std::span<const Vec3> start, std::span<const Vec3> end);

  // Finds the contacts of the deforming surface with obstacles, sorted, and the pairs of a triangle of the
  // surface and one of an obstacle that cross at the start. With `first`, only contacts of the earliest time
  // are asked for, and with `time_alone` too, only what tells that time (Step::time_alone). Without
  // `see_start`, `start` stays empty.
  void step(const Motion& own, bool first, bool time_alone, bool see_start, ContactSet& found,
            Crossings& start);
  // The motion of together() in the last step in which the surface's box came near an obstacle. Contacts of
  // that step refer to it, until find_candidates() is called.
  Motion motion() const { return {start_, end_}; }

  // Replaces the content of `out` by the feature pairs of a feature of the deforming surface and a feature of
  // an obstacle that CandidateSet takes. The thickness is about together().
  void find_candidates(const Motion& own, const Thickness& thickness, std::vector<FeaturePair>& out);

 private:
  class ObstaclePairs;

  void make_detectors();
  bool near(const Aabb& box) const;
  void bring_up_to_date();
  bool starts_where_a_free_step_ended(const Motion& own) const;

  std::size_t own_vertices_;
  TriangleMesh together_;
  const ElementaryTest& elementary_;
  const Exclusions* exclusions_ = nullptr;
  Thickness thickness_;
  std::vector<std::size_t> first_vertex_;  // in together(), and the number of all vertices at the end
  std::vector<Vec3> start_, end_;          // [vertices of together()], of the last step that came near
  std::vector<bool> follows_;  // [obstacles]: its next start is where the last step left it, bit for bit
  std::vector<bool> moved_;    // [obstacles]: has been moved since the last step
  std::vector<bool> at_rest_;  // [obstacles]: starts where it ends
  bool has_loose_ = false;     // some vertex of an obstacle is of no triangle
  bool stale_ = false;         // some obstacle's bounds are those of another motion
  bool free_ = false;          // the last step was near, started without crossings and had no contact
  std::unique_ptr<ObstaclePairs> pairs_;
  std::unique_ptr<Detector> first_, all_;
  EmbeddingTest start_test_;
  std::optional<CandidateSet> candidates_;
};

}  // namespace cscd
