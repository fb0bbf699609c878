#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/mesh/triangle_mesh.h"

namespace cscd::fast {

// Lengths of shortest paths over the triangles of a surface. A step leads from the middle of a triangle to
// the middle of a triangle that shares a vertex with it, or of one that shares an edge. Steps across edges
// alone have so few directions that the lines of equal length run slantwise round a limb whose mesh is
// regular.
//
// The surface is divided into pieces, which the caller numbers: `piece` is [triangles].
class TrianglePaths {
 public:
  enum class Steps { over_vertices, across_edges };
  TrianglePaths(const TriangleMesh& mesh, std::span<const Vec3> positions,
                Steps steps = Steps::over_vertices);

  // Computes the lengths of the shortest paths from the seeds to the triangles `reached`. A path stays within
  // one piece. `reached` must hold all triangles of the seeds' pieces. A triangle that no path leads to has
  // an infinite length.
  void measure(std::span<const std::int32_t> piece, std::span<const TriangleId> reached,
               std::span<const TriangleId> seeds);
  // Lets the pieces of the seeds grow over the triangles `reached`, which hold the seeds: each triangle then
  // belongs to the piece from whose seeds the shortest path leads to it. A step that leads from piece p
  // counts `stretch[p]` times its length.
  void grow(std::span<std::int32_t> piece, std::span<const TriangleId> reached,
            std::span<const TriangleId> seeds, std::span<const double> stretch);

  // Returns the length of the path to a triangle that the last call has reached.
  double length(TriangleId t) const { return length_[+t]; }

  struct Step {
    TriangleId to;
    double length;
  };
  // Returns the steps that lead from a triangle.
  std::span<const Step> steps_from(TriangleId t) const {
    return std::span(steps_).subspan(first_step_[+t], first_step_[+t + 1] - first_step_[+t]);
  }

 private:
  void put(TriangleId t, double length);
  template <class LengthOf, class Take>  // (from, step): its length; (from, to): a shorter path leads to `to`
  void flood(std::span<const TriangleId> reached, std::span<const TriangleId> seeds,
             const LengthOf& length_of, const Take& take);

  std::vector<double> length_;           // [triangles]
  std::vector<std::size_t> first_step_;  // [triangles + 1]
  std::vector<Step> steps_;
  double bucket_width_ = 1;
  std::vector<std::vector<Step>> buckets_;  // the triangles to go on from, with the length of the path there
};

// A part of a surface that sticks out and is long for its girth, such as a finger or a tentacle. A surface
// without branches, such as a rope, is one limb. The lines of equal `along` go round the limb.
struct Limb {
  std::vector<TriangleId> triangles;
  std::vector<double> along;  // [triangles]: grows from the limb's root to its tip

  double lowest() const;
  double length() const;
};

// A connected component of a surface, divided into its limbs and what they stick out from, the hub.
struct Body {
  std::vector<Limb> limbs;
  std::vector<TriangleId> hub;  // empty where the component is one limb
};

// Divides a connected component into limbs and a hub. `component` holds its triangles. `piece` and `area` are
// [triangles of the mesh]: the component of each triangle, and its area. A limb reaches into the hub by about
// its own radius, because that is where limbs bend. Uses the paths as scratch memory.
Body body_of(TrianglePaths& paths, std::span<const double> area, std::span<const std::int32_t> piece,
             std::span<const TriangleId> component);

}  // namespace cscd::fast
