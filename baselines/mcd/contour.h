#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/vec3.h"
#include "core/mesh/motion.h"

namespace cscd::mcd {

// The continuous contour test: decides whether a closed loop of moving vertices, projected along a direction,
// is a simple curve at every t in [0, 1].
//
// Coordinates in the plane are those of p - p_z d / d_z, times d_z. So points that are projected on one point
// differ by an exact multiple of the direction. Each edge has boxes at both ends of the interval. Two edges
// are apart throughout if their boxes are apart on the same side at both ends, because all points move
// linearly. A hierarchy over the loop finds the pairs of edges for which that fails. Two of those edges that
// share no vertex are apart if the line of one keeps the other on one side at all t. Two neighbouring edges
// are apart but for their common vertex if they never point the same way from it. Both conditions are signs
// of quadratics in t; a sign is certain if the Bernstein coefficients exceed a bound of the rounding.
class ContourTest {
 public:
  // Returns true only if the loop is certainly simple; false proves nothing. `loop` lists the vertices in
  // order. The time is linear in the loop where the boxes settle most pairs, and quadratic at worst.
  bool simple(std::span<const VertexId> loop, const Vec3& direction, const Motion& motion);

  // The number of tests of two boxes since restart().
  std::uint64_t box_tests() const { return box_tests_; }
  void restart() { box_tests_ = 0; }

 private:
  struct Point {
    double start[2], end[2];
  };
  struct Box {  // lower bounds along both axes, then along their negatives
    double start[4], end[4];
  };
  void project(std::span<const VertexId> loop, const Vec3& direction, const Motion& motion);
  Box build(std::size_t node, std::size_t first, std::size_t count);
  bool self(std::size_t node, std::size_t first, std::size_t count);
  bool pair(std::size_t a, std::size_t first_a, std::size_t count_a, std::size_t b, std::size_t first_b,
            std::size_t count_b);
  bool edges_apart(std::size_t a, std::size_t b) const;
  bool side_certain(std::size_t from, std::size_t to, std::size_t a, std::size_t b) const;
  bool corner_open(std::size_t before, std::size_t corner, std::size_t after) const;
  std::size_t after(std::size_t i) const { return i + 1 == points_.size() ? 0 : i + 1; }

  std::vector<Point> points_;  // [loop]; edge i runs from point i to the next one
  double slack_ = 0;           // bound of a coordinate's error
  std::vector<Box> boxes_;     // nodes of a binary tree over the edges, in depth-first order
  std::uint64_t box_tests_ = 0;
};

}  // namespace cscd::mcd
