#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <vector>

#include "bench/query/answer/overlap_events.h"
#include "bench/query/view/sections.h"

namespace cscd::bench {

// Collects which vertices lie in the other sheet of an event at the start of each interval, and how deep.
class OverlapRecording {
 public:
  // Adds the next interval, whose regions have the ways of their vertices.
  void add(const OverlapEvents::Here& here);
  void write(Sections& sections) const;

 private:
  std::vector<std::uint32_t> count_;  // [intervals]
  std::vector<std::int32_t> vertex_;
  std::vector<float> depth_;  // [vertices]
};

// Returns what the page says of each event, deepest first: its number in summary.events, and a line of text.
nlohmann::json event_lines(const Input& input, std::span<const OverlapEvent> events);

}  // namespace cscd::bench
