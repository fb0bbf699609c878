#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/vec3.h"
#include "core/mesh/motion.h"

namespace cscd::mcd {

// The continuous contour test: whether a closed loop of moving vertices, projected along a direction, is a
// simple curve at every t in [0, 1].
//
// Coordinates in the plane are x - z d_x / d_z and the like, so what is projected on one point differs by a
// multiple of the direction exactly. Each edge is boxed at both ends of the interval; two edges are apart
// throughout if their boxes are apart at both ends on the same side, because all moves linearly. A hierarchy
// over the loop finds the pairs that are not. Two of these that share no vertex are apart if one's line keeps
// the other on one side at all t, two neighbours if they never point the same way from their common vertex:
// both are signs of quadratics in t, certain when their Bernstein coefficients exceed a bound of the
// rounding.
//
// True is a proof, false is none. Linear in the loop where it passes easily, quadratic at worst.
class ContourTest {
 public:
  bool simple(std::span<const VertexId> loop, const Vec3& direction, const Motion& motion);

  std::uint64_t box_tests() const { return box_tests_; }
  void restart() { box_tests_ = 0; }

 private:
  struct Point {
    double start[2], end[2];
  };
  struct Box {  // at both ends: lower bounds along both axes, then along their negatives
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

  std::vector<Point> points_;  // of the loop; edge i runs from point i to the next one
  double slack_ = 0;           // by which a coordinate may be off
  std::vector<Box> boxes_;     // of a binary tree over the edges in depth-first order
  std::uint64_t box_tests_ = 0;
};

}  // namespace cscd::mcd
