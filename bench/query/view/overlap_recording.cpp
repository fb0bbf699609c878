#include "bench/query/view/overlap_recording.h"

#include <algorithm>
#include <cmath>

#include "bench/answer/event_text.h"

namespace cscd::bench {

void OverlapRecording::add(const OverlapEvents::Here& here, std::span<const Vec3> start) {
  const std::size_t before = vertex_.size(), curves_before = curve_points_.size();
  std::size_t points = 0;
  for (std::size_t i = 0; i < here.event.size(); ++i) {
    if (here.event[i] == OverlapEvents::kNone) continue;
    for (const std::int32_t curve : here.overlaps.overlaps[i].curves)
      points +=
          add_curve(here.overlaps.crossing, here.overlaps.crossing.curves[static_cast<std::size_t>(curve)],
                    start, kMostPoints - points);
    curve_event_.resize(curve_points_.size(), static_cast<std::uint32_t>(here.event[i]));
    for (const CrossingRegion& region : here.overlaps.overlaps[i].regions)
      for (std::size_t k = 0; k < region.vertices.size(); ++k) {
        vertex_.push_back(static_cast<std::int32_t>(region.vertices[k]));
        depth_.push_back(static_cast<float>(region.way[k].norm()));
      }
  }
  count_.push_back(static_cast<std::uint32_t>(vertex_.size() - before));
  curves_.push_back(static_cast<std::uint32_t>(curve_points_.size() - curves_before));
}

std::size_t OverlapRecording::add_curve(const CrossingCurves& all, const CrossingCurve& curve,
                                        std::span<const Vec3> start, std::size_t room) {
  const std::size_t points = curve.nodes.size() + curve.closed();
  if (points > room) return 0;
  for (std::size_t i = 0; i < points; ++i) {
    const CrossingCurve::Node& node = curve.nodes[i % curve.nodes.size()];
    VertexId from = node.vertex, to = node.vertex;
    double share = 0;
    if (node.piercing >= 0) {
      const Piercing& piercing = all.piercings[static_cast<std::size_t>(node.piercing)];
      from = piercing.before, to = piercing.behind;
      const Vec3 edge = start[+to] - start[+from];
      share = edge.dot(piercing.point - start[+from]) / edge.squaredNorm();
    }
    edge_.push_back(static_cast<std::int32_t>(from));
    edge_.push_back(static_cast<std::int32_t>(to));
    share_.push_back(static_cast<std::uint16_t>(std::lround(65535 * std::clamp(share, 0.0, 1.0))));
  }
  curve_points_.push_back(static_cast<std::uint32_t>(points));
  return points;
}

void OverlapRecording::write(Sections& sections) const {
  sections.add("inside_count", count_);
  sections.add("inside_vertex", vertex_);
  sections.add("inside_depth", depth_);
  sections.add("curve_count", curves_);
  sections.add("curve_points", curve_points_);
  sections.add("curve_event", curve_event_);
  sections.add("curve_edge", edge_);
  sections.add("curve_share", share_);
}

nlohmann::json event_lines(const ClipAnswer& answer) {
  nlohmann::json out = nlohmann::json::array();
  std::vector<std::size_t> order = deepest_first(answer.events);
  std::stable_partition(order.begin(), order.end(),
                        [&](std::size_t i) { return !answer.joints.fold(answer.events[i]); });
  for (const std::size_t i : order)
    out.push_back({{"event", i}, {"text", event_text(answer.input, answer.events[i])}});
  return out;
}

}  // namespace cscd::bench
