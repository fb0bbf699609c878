#include "bench/query/view/overlap_recording.h"

#include "bench/query/answer/answer_text.h"

namespace cscd::bench {

void OverlapRecording::add(const OverlapEvents::Here& here) {
  const std::size_t before = vertex_.size();
  for (std::size_t i = 0; i < here.event.size(); ++i) {
    if (here.event[i] == OverlapEvents::kNone) continue;
    for (const CrossingRegion& region : here.overlaps.overlaps[i].regions)
      for (std::size_t k = 0; k < region.vertices.size(); ++k) {
        vertex_.push_back(static_cast<std::int32_t>(region.vertices[k]));
        depth_.push_back(static_cast<float>(region.way[k].norm()));
      }
  }
  count_.push_back(static_cast<std::uint32_t>(vertex_.size() - before));
}

void OverlapRecording::write(Sections& sections) const {
  sections.add("inside_count", std::span<const std::uint32_t>(count_));
  sections.add("inside_vertex", std::span<const std::int32_t>(vertex_));
  sections.add("inside_depth", std::span<const float>(depth_));
}

nlohmann::json event_lines(const Input& input, std::span<const OverlapEvent> events) {
  nlohmann::json out = nlohmann::json::array();
  for (const std::size_t i : deepest_first(events))
    out.push_back({{"event", i}, {"text", event_text(input, events[i])}});
  return out;
}

}  // namespace cscd::bench
