#include "core/engine/following_point.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstring>

#include "core/geometry/lanes16.h"

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

float reach_of(const Viewpoint& viewpoint, float error) {
  float largest = 0;
  for (const auto& end : viewpoint.at)
    for (const float coordinate : end) largest = std::max(largest, std::abs(coordinate));
  return 1.0001F * (0x1p24F * error + largest);  // the rest pays for roundings and for twice the error
}

Viewpoint placed(const FollowingPoint& point, std::span<const LocalPositions::Record> records) {
  Float8 sum = {};
  for (std::size_t i = 0; i < point.vertices().size(); ++i) {
    Float8 record;
    std::memcpy(&record, records[+point.vertices()[i]].at, sizeof record);
    sum += point.weights()[i] * record;
  }
  Viewpoint out;
  for (std::size_t end = 0; end < 2; ++end)
    for (std::size_t k = 0; k < 3; ++k) out.at[end][k] = sum[4 * end + k];
  return out;
}

}  // namespace cscd::fast
