#include "core/crossing/pieces.h"

#include <algorithm>

#include "core/detect/start/crossings.h"

namespace cscd {

OverlapPieces::OverlapPieces(const TriangleMesh& mesh, const Overlaps& all,
                             std::span<const std::size_t> number) {
  for (std::size_t i = 0; i < number.size(); ++i) {
    if (number[i] == kNone) continue;
    const auto add = [&](TriangleId t) {
      triangles_.push_back(static_cast<std::uint64_t>(+t) << 32 | number[i]);
    };
    for_each_segment(all.crossing, all.overlaps[i], [&](const auto& segment) {
      for (const TriangleId t : segment) add(t);
    });
    for (const CrossingRegion& region : all.overlaps[i].regions)
      for (const VertexId v : region.vertices)
        for (const TriangleId t : mesh.triangles_at(v)) add(t);
  }
  std::ranges::sort(triangles_);
  triangles_.erase(std::unique(triangles_.begin(), triangles_.end()), triangles_.end());
}

std::size_t OverlapPieces::find(TriangleId a, TriangleId b) const {
  const auto numbers_of = [&](TriangleId t) {
    const std::uint64_t first = static_cast<std::uint64_t>(+t) << 32;
    const auto from = std::lower_bound(triangles_.begin(), triangles_.end(), first);
    return std::span(from, std::lower_bound(from, triangles_.end(), first + (std::uint64_t{1} << 32)));
  };
  for (const std::uint64_t one : numbers_of(a))
    for (const std::uint64_t other : numbers_of(b))
      if (constexpr std::uint64_t kNumber = 0xffffffff; (one & kNumber) == (other & kNumber))
        return one & kNumber;
  return kNone;
}

std::size_t OverlapPieces::find(const TriangleMesh& mesh, const FeaturePair& pair) const {
  std::size_t found = kNone;
  for (const auto& [a, b] : carriers(mesh, pair)) found = std::min(found, find(a, b));
  return found;
}

}  // namespace cscd
