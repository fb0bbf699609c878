#include "library/engine/crossings.h"

#include <algorithm>

#include "core/base/error.h"
#include "core/crossing/length_gradient.h"

namespace cscd {
namespace {

SelfCollision::Crossings::Curve written(const CrossingCurves& all, const CrossingCurve& curve,
                                        std::span<const Vec3> positions) {
  SelfCollision::Crossings::Curve out;
  out.closed = curve.closed();
  for (const auto& [a, b] : curve.segments) out.faces.push_back({static_cast<int>(a), static_cast<int>(b)});
  for (const CrossingCurve::Node& node : curve.nodes) out.points.push_back(all.point(node, positions));
  return out;
}

SelfCollision::Crossings::Region written(const Overlap& overlap, const CrossingRegion& region) {
  SelfCollision::Crossings::Region out;
  for (const std::int32_t image : region.images)
    out.bounds.push_back(
        {static_cast<int>(std::ranges::find(overlap.curves, image / 2) - overlap.curves.begin()), image % 2});
  for (const VertexId v : region.vertices) out.vertices.push_back(static_cast<int>(v));
  out.way = region.way;
  for (const Vec3& way : region.way) out.distance.push_back(way.norm());
  out.area = region.area;
  out.behind = region.side == CrossingRegion::Side::behind;
  out.other_is_open = region.other_is_open;
  out.depth = region.depth.lower;
  out.depth_bound = region.depth.upper;
  out.deepest = static_cast<int>(region.depth.vertex);
  out.out = region.depth.out;
  return out;
}

}  // namespace

bool CrossingSearch::excludes(const Exclusions& excluded, const CrossingCurves& all,
                              const Overlap& overlap) const {
  if (excluded.empty()) return false;
  std::size_t pairs = 0, left_out = 0;
  for_each_segment(all, overlap, [&](const auto& segment) {
    ++pairs;
    left_out += excluded.excludes(mesh_, TrianglePair{segment[0], segment[1]});
  });
  return 2 * left_out >= pairs;
}

Overlaps CrossingSearch::overlaps(std::span<const Vec3> positions, bool each_way) {
  const Crossings pairs = pairs_.find_all(positions, kMostCrossings);
  if (!pairs.all_kept())
    throw InputError("crossings: " + std::to_string(pairs.total) + " pairs of faces cross, more than " +
                     std::to_string(kMostCrossings) + "; the surface has collapsed");
  return finder_.find(positions, pairs.pairs, each_way);
}

OverlapPieces CrossingSearch::find_pieces(std::span<const Vec3> positions, const Exclusions& excluded) {
  const Overlaps found = overlaps(positions, false);
  std::vector<std::size_t> number;
  for (const Overlap& overlap : found.overlaps)
    number.push_back(excludes(excluded, found.crossing, overlap) ? OverlapPieces::kNone : number.size());
  return OverlapPieces(mesh_, found, number);
}

SelfCollision::Crossings CrossingSearch::find(std::span<const Vec3> positions, const Exclusions& excluded) {
  const Overlaps found = overlaps(positions, true);
  SelfCollision::Crossings out;
  out.touching = found.crossing.touching;
  for (const Overlap& overlap : found.overlaps) {
    if (excludes(excluded, found.crossing, overlap)) continue;
    SelfCollision::Crossings::Overlap& one = out.overlaps.emplace_back();
    for (const std::int32_t curve : overlap.curves)
      one.curves.push_back(
          written(found.crossing, found.crossing.curves[static_cast<std::size_t>(curve)], positions));
    for (const CrossingRegion& region : overlap.regions) one.regions.push_back(written(overlap, region));
    CurveLength length = length_gradient(mesh_, positions, found.crossing, overlap);
    one.length = length.length;
    for (const auto& [v, gradient] : length.gradient) {
      one.vertices.push_back(static_cast<int>(v));
      one.gradient.push_back(gradient);
    }
    one.depth = overlap.depth.lower;
    one.depth_bound = overlap.depth.upper;
  }
  return out;
}

}  // namespace cscd
