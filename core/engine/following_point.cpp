#include "core/engine/following_point.h"

namespace cscd::fast {

Vec3 FollowingPoint::at(std::span<const Vec3> positions) const {
  Vec3 sum = Vec3::Zero();
  for (std::size_t v = 0; v < vertices.size(); ++v)
    sum += static_cast<double>(weights[v]) * positions[+vertices[v]];
  return sum;
}

Viewpoint placed(const FollowingPoint& point, std::span<const LocalPositions::Record> records) {
  float sum[8] = {};
  for (std::size_t v = 0; v < point.vertices.size(); ++v)
    for (std::size_t k = 0; k < 8; ++k) sum[k] += point.weights[v] * records[+point.vertices[v]].at[k];
  Viewpoint out;
  for (std::size_t end = 0; end < 2; ++end)
    for (std::size_t k = 0; k < 3; ++k) out.at[end][k] = sum[4 * end + k];
  return out;
}

}  // namespace cscd::fast
