#include "bench/answer/rest_depths.h"

#include <algorithm>
#include <limits>
#include <span>

#include "core/base/sort_unique.h"
#include "core/detect/start/rest_crossings.h"

namespace cscd::bench {

RestDepths::RestDepths(const TriangleMesh& mesh, OverlapFinder& finder, std::span<const Vec3> rest,
                       std::span<const CrossingPair> pairs) {
  const Overlaps all = finder.find(rest, pairs);
  for (std::size_t i = 0; i < all.overlaps.size(); ++i) {
    const CrossingDepth& depth = all.overlaps[i].depth;
    depth_.push_back(depth.lower > 0 ? depth.lower : depth.upper);
    std::vector<TriangleId> crossed;
    for_each_segment(all.crossing, all.overlaps[i], [&](const auto& segment) {
      crossed.insert(crossed.end(), segment.begin(), segment.end());
    });
    sort_unique(crossed);
    for (const TriangleId center : crossed)
      for (const TriangleId t : within_rings(mesh, center, RestCrossings::kRings)) near_.emplace_back(t, i);
  }
  sort_unique(near_);
}

double RestDepths::most_near(const CrossingCurves& all, const Overlap& overlap) const {
  const auto of = [&](TriangleId triangle) {
    const auto first = std::ranges::lower_bound(near_, std::pair(triangle, std::size_t{0}));
    const auto last =
        std::ranges::upper_bound(near_, std::pair(triangle, std::numeric_limits<std::size_t>::max()));
    return std::span(first, last);
  };
  double most = 0;
  for_each_segment(all, overlap, [&](const auto& segment) {
    const auto others = of(segment[1]);
    for (const auto& [triangle, number] : of(segment[0]))
      if (depth_[number] > most && std::ranges::binary_search(others, std::pair(segment[1], number)))
        most = depth_[number];
  });
  return most;
}

}  // namespace cscd::bench
