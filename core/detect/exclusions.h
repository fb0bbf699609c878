#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/vec3.h"
#include "core/detect/contact.h"
#include "core/detect/culler.h"
#include "core/mesh/triangle_mesh.h"

namespace cscd {

// Which vertices may collide with which: what a simulator leaves out of its collisions.
//
// Two features may collide if *some* vertex of one may collide with *some* vertex of the other. So a feature
// pair is excluded only if all its pairs of vertices are, and so is a pair of triangles. A pair of triangles
// can also be excluded by itself, or because the groups of its triangles ignore each other. A feature pair is
// then excluded if every pair of triangles that carries it is.
class Exclusions {
 public:
  // Whether nothing is excluded.
  bool empty() const;

  // Rigid vertices, [vertices], do not collide with each other. Throws InputError for a wrong size.
  void set_rigid(const TriangleMesh& mesh, std::vector<bool> rigid);
  // Vertices whose groups ignore each other do not collide; a group may ignore itself. `group`, [vertices],
  // holds numbers from 0. Throws InputError for a wrong size, and for a pair with a group that no vertex has.
  void set_groups(const TriangleMesh& mesh, std::vector<std::int32_t> group,
                  std::span<const std::pair<std::int32_t, std::int32_t>> ignoring);
  // Does for triangles, whose groups `group`, [triangles], holds, what set_groups() does for vertices. All
  // vertices of no triangle are of the group `points`, if that is not negative.
  void set_triangle_groups(const TriangleMesh& mesh, std::vector<std::int32_t> group,
                           std::span<const std::pair<std::int32_t, std::int32_t>> ignoring,
                           std::int32_t points = -1);
  // Excludes pairs of vertices, and pairs of triangles. Throws InputError for an index out of range.
  void exclude(const TriangleMesh& mesh, std::span<const std::pair<VertexId, VertexId>> pairs);
  void exclude(const TriangleMesh& mesh, std::span<const std::pair<TriangleId, TriangleId>> pairs);
  // Excludes pairs of vertices that a path of at most `rings` edges joins.
  void exclude_rings(const TriangleMesh& mesh, int rings);
  // Excludes pairs of vertices that are nearer to each other than `distance` in the pose `reference`.
  void exclude_near(std::span<const Vec3> reference, double distance);

  bool excludes(VertexId u, VertexId v) const;
  bool excludes(const TriangleMesh& mesh, const TrianglePair& pair) const;
  bool excludes(const TriangleMesh& mesh, const FeaturePair& pair) const;

 private:
  // Which group each vertex, or each triangle, belongs to, and which groups ignore each other.
  struct Groups {
    std::vector<std::int32_t> of;  // empty where no groups ignore each other
    std::size_t count = 0;
    std::vector<bool> ignoring;  // [count][count]

    bool ignore(std::size_t i, std::size_t j) const {
      return !of.empty() &&
             ignoring[static_cast<std::size_t>(of[i]) * count + static_cast<std::size_t>(of[j])];
    }
  };
  static Groups groups_of(std::vector<std::int32_t> group, std::string_view what,
                          std::span<const std::pair<std::int32_t, std::int32_t>> ignoring);

  std::vector<bool> rigid_;
  Groups vertex_groups_, triangle_groups_;
  std::size_t points_ = 0;  // where points have a group: its place behind those of the triangles
  std::vector<std::uint64_t> vertex_pairs_;    // sorted; the smaller index in the upper half
  std::vector<std::uint64_t> triangle_pairs_;  // sorted; the smaller index in the upper half
  std::vector<Vec3> reference_;
  // The power of two that makes the distance about 1, so that no square overflows or vanishes, and the
  // distance in that scale.
  double scale_ = 1, near_ = 0;
};

}  // namespace cscd
