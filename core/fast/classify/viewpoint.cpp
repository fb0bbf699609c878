#include "core/fast/classify/viewpoint.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "core/geometry/simd_floats.h"

namespace cscd::fast {

float reach_of(const Viewpoint& viewpoint, float error) {
  float largest = 0;
  for (const auto& end : viewpoint.at)
    for (const float coordinate : end) largest = std::max(largest, std::abs(coordinate));
  return 1.0001F * (0x1p24F * error + largest);  // 0.0001 pays for roundings and for twice the error
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
  if (!point.stands_off()) return out;
  // By as much at both ends, so that the viewpoint moves in a straight line.
  std::array<Vec3, FollowingPoint::kMost> corners;
  for (std::size_t i = 0; i < point.vertices().size(); ++i) {
    const float(&at)[8] = records[+point.vertices()[i]].at;
    corners[i] = Vec3(at[0], at[1], at[2]);
  }
  const Vec3 offset = point.offset(std::span(corners).first(point.vertices().size()));
  for (auto& end : out.at)
    for (int k = 0; k < 3; ++k) end[k] += static_cast<float>(offset[k]);
  return out;
}

}  // namespace cscd::fast
