#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <vector>

#include "bench/answer/clip_answer.h"
#include "bench/query/view/sections.h"

namespace cscd::bench {

// Collects the curves of events at the start of each interval, and which vertices lie in the other sheet, how
// deep.
class OverlapRecording {
 public:
  // Adds the next interval, whose regions have the displacements of their vertices.
  void add(const OverlapEvents::Here& here, std::span<const Vec3> start);
  void write(Sections& sections) const;

 private:
  // Points of curves that are kept of one interval. A curve for which there is no room is left out; those of
  // the deepest overlaps come first.
  static constexpr std::size_t kMostPoints = 20'000;

  // Adds a curve of at most `room` points, and returns the number of points.
  std::size_t add_curve(const CrossingCurves& all, const CrossingCurve& curve, std::span<const Vec3> start,
                        std::size_t room);

  std::vector<std::uint32_t> count_;  // [intervals]
  std::vector<std::int32_t> vertex_;
  std::vector<float> depth_;                 // [vertices]
  std::vector<std::uint32_t> curves_;        // [intervals]
  std::vector<std::uint32_t> curve_points_;  // [curves]; a closed curve has its first point twice
  std::vector<std::uint32_t> curve_event_;   // [curves]
  std::vector<std::int32_t> edge_;           // [points][2], the edge of the surface on which a point lies
  std::vector<std::uint16_t> share_;         // [points], of the way along that edge, of 65535
};

// Returns what the page says of each event, deepest first and those at joints last: its number in
// summary.events, and a line of text.
nlohmann::json event_lines(const ClipAnswer& answer);

}  // namespace cscd::bench
