#include "core/crossing/skins.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "core/base/sort_unique.h"

namespace cscd {

void Skins::spread() {
  for (auto& [both, triangles] : triangles_) {
    sort_unique(triangles);
    spread(triangles);
  }
}

void Skins::spread(std::vector<TriangleId>& triangles) const {
  std::set<TriangleId> known(triangles.begin(), triangles.end());
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const Triangle c = mesh_.corners(triangles[i]);
    const Vec3& origin = positions_[+c[0]];
    const Vec3 normal = (positions_[+c[1]] - origin).cross(positions_[+c[2]] - origin);
    const double slack = on_plane_ * normal.norm();
    const auto is_in_plane = [&](VertexId v) {
      return std::abs(normal.dot(positions_[+v] - origin)) <= slack;
    };
    if (!(slack > 0)) continue;
    for (const EdgeId edge : mesh_.edges_of(triangles[i]))
      for (const TriangleId next : mesh_.triangles_at(edge))
        if (!known.contains(next) && std::ranges::all_of(mesh_.corners(next), is_in_plane)) {
          known.insert(next);
          triangles.push_back(next);
        }
  }
}

const SheetDistance& Skins::to(std::int32_t own, std::int32_t other) {
  const std::pair both(own, other);
  SheetDistance& distance =
      distances_.try_emplace(both, mesh_, positions_, triangles_.at(both)).first->second;
  distance.start_anew();
  return distance;
}

}  // namespace cscd
