#include "core/crossing/pieces.h"

#include <algorithm>

#include "core/detect/start/crossings.h"

namespace cscd {

OverlapPieces::OverlapPieces(const TriangleMesh& mesh, const Overlaps& all,
                             std::span<const std::size_t> number) {
  for (std::size_t i = 0; i < number.size(); ++i) {
    if (number[i] == kNone) continue;
    for_each_segment(all.crossing, all.overlaps[i], [&](const auto& segment) {
      for (const TriangleId t : segment) triangles_.emplace_back(t, number[i]);
    });
    for (const CrossingRegion& region : all.overlaps[i].regions)
      for (const VertexId v : region.vertices)
        for (const TriangleId t : mesh.triangles_at(v)) triangles_.emplace_back(t, number[i]);
  }
  std::ranges::sort(triangles_);
  triangles_.erase(std::unique(triangles_.begin(), triangles_.end()), triangles_.end());
}

std::size_t OverlapPieces::find(TriangleId a, TriangleId b) const {
  const auto numbers_of = [&](TriangleId t) {
    return std::ranges::equal_range(triangles_, t, {}, [](const auto& entry) { return entry.first; });
  };
  for (const auto& entry : numbers_of(a))
    for (const auto& other : numbers_of(b))
      if (entry.second == other.second) return entry.second;
  return kNone;
}

std::size_t OverlapPieces::find(const TriangleMesh& mesh, const FeaturePair& pair) const {
  std::size_t found = kNone;
  for (const auto& [a, b] : carriers(mesh, pair)) found = std::min(found, find(a, b));
  return found;
}

}  // namespace cscd
