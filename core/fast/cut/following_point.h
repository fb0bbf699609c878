#pragma once

#include <array>
#include <span>

#include "core/base/ids.h"
#include "core/base/vec3.h"

namespace cscd::fast {

// A point that follows the surface: an affine combination of at most `kMost` vertices. Vertices and weights
// are stored inside the object, because hundreds of points are placed one after the other in every interval.
class FollowingPoint {
 public:
  static constexpr std::size_t kMost = 16;
  // The absolute values of the weights may sum to this much. A point with such weights is at most that many
  // times as far away as the farthest local position (local_positions.h), and triple products with it are far
  // from overflow.
  static constexpr float kMostWeight = 1000;

  // May be called at most `kMost` times.
  void add(VertexId vertex, float weight);
  std::span<const VertexId> vertices() const { return std::span(vertices_).first(count_); }
  // The weights sum to 1 up to rounding. The point is defined as the sum with exactly these weights.
  std::span<const float> weights() const { return std::span(weights_).first(count_); }

  Vec3 at(std::span<const Vec3> positions) const;

 private:
  std::array<VertexId, kMost> vertices_{};
  std::array<float, kMost> weights_{};
  std::size_t count_ = 0;
};

}  // namespace cscd::fast
