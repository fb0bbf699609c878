#pragma once

#include <array>
#include <span>

#include "core/base/ids.h"
#include "core/base/vec3.h"

namespace cscd::fast {

// A point that follows the surface: an affine combination of a few vertices. Held by value, as hundreds are
// placed one after the other in every interval.
class FollowingPoint {
 public:
  static constexpr std::size_t kMost = 16;
  // To which the sizes of weights may sum. Triple products with a point that is this much farther away than
  // any local position (local_positions.h) are far from overflow.
  static constexpr float kMostWeight = 1000;

  // At most `kMost` times.
  void add(VertexId vertex, float weight);
  std::span<const VertexId> vertices() const { return std::span(vertices_).first(count_); }
  // They sum to about 1: what they sum to exactly is the point.
  std::span<const float> weights() const { return std::span(weights_).first(count_); }

  Vec3 at(std::span<const Vec3> positions) const;

 private:
  std::array<VertexId, kMost> vertices_{};
  std::array<float, kMost> weights_{};
  std::size_t count_ = 0;
};

}  // namespace cscd::fast
