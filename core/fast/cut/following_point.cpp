#include "core/fast/cut/following_point.h"

#include <cassert>

namespace cscd::fast {

void FollowingPoint::add(VertexId vertex, float weight) {
  assert(count_ < kMost);
  vertices_[count_] = vertex;
  weights_[count_++] = weight;
}

Vec3 FollowingPoint::at(std::span<const Vec3> positions) const {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < count_; ++i) sum += static_cast<double>(weights_[i]) * positions[+vertices_[i]];
  return sum;
}

}  // namespace cscd::fast
