#pragma once

#include <array>
#include <span>

#include "core/base/ids.h"
#include "core/base/vec3.h"

namespace cscd::fast {

// A point that follows the surface: an affine combination of a few vertices, from which it may stand off
// along the normal that these vertices carry. It is held by value, because hundreds of points are placed one
// after the other in every interval.
class FollowingPoint {
 public:
  static constexpr std::size_t kMost = 16;
  // The largest sum of the sizes of the weights. A point that is this much farther away than any local
  // position (local_positions.h) leaves triple products far from overflow.
  static constexpr float kMostWeight = 1000;

  // Adds a vertex with its weight; at most kMost vertices can be added.
  void add(VertexId vertex, float weight);
  std::span<const VertexId> vertices() const { return std::span(vertices_).first(count_); }
  // The weights sum to about 1. The point is defined by what they sum to exactly.
  std::span<const float> weights() const { return std::span(weights_).first(count_); }

  // Lets the point stand off its vertices. An affine combination of vertices in one plane lies in that plane,
  // from which nothing of it can be seen. The vertices are then the corners of a polygon, in the order in
  // which they were added, and `height` is in units of the square root of its area; a negative one is behind
  // it.
  void stand_off(float height) { height_ = height; }
  bool stands_off() const { return height_ != 0; }
  float height() const { return height_; }
  // Returns by how much the point stands off its affine combination, from where the vertices are, `corners`,
  // [vertices()]. Zero if the polygon has no area.
  Vec3 offset(std::span<const Vec3> corners) const;

  Vec3 at(std::span<const Vec3> positions) const;

 private:
  std::array<VertexId, kMost> vertices_{};
  std::array<float, kMost> weights_{};
  std::size_t count_ = 0;
  float height_ = 0;
};

}  // namespace cscd::fast
