#include "core/fast/prepare/following_point.h"

#include <cassert>
#include <cmath>

namespace cscd::fast {

void FollowingPoint::add(VertexId vertex, float weight) {
  assert(count_ < kMost);
  vertices_[count_] = vertex;
  weights_[count_++] = weight;
}

Vec3 FollowingPoint::offset(std::span<const Vec3> corners) const {
  Vec3 area = Vec3::Zero();
  for (std::size_t i = 1; i + 1 < corners.size(); ++i)
    area += 0.5 * (corners[i] - corners[0]).cross(corners[i + 1] - corners[0]);
  const double size = std::sqrt(area.norm());
  return size > 0 ? Vec3(area * (static_cast<double>(height_) / size)) : Vec3(Vec3::Zero());
}

Vec3 FollowingPoint::at(std::span<const Vec3> positions) const {
  Vec3 sum = Vec3::Zero();
  std::array<Vec3, kMost> corners;
  for (std::size_t i = 0; i < count_; ++i) {
    corners[i] = positions[+vertices_[i]];
    sum += static_cast<double>(weights_[i]) * corners[i];
  }
  return stands_off() ? Vec3(sum + offset(std::span(corners).first(count_))) : sum;
}

}  // namespace cscd::fast
