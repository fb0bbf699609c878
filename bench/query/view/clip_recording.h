#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bench/inputs/input.h"
#include "bench/query/view/position_coder.h"
#include "bench/query/view/sections.h"

namespace cscd::bench {

// Throws InputError if a page of so many frames would be too large for a browser. `what` begins the error,
// and `remedy` ends it. `more_bytes` are those of a vertex of a frame beside its place on the grid.
void require_page_room(std::size_t frames, std::size_t vertices, std::size_t more_bytes,
                       const std::string& what, const std::string& remedy);

// Collects the moving surface for a page: positions on a grid, bones, and the ends of intervals that lead to
// a prediction instead of the next frame.
class ClipRecording {
 public:
  // Reads all frames of the range once, for the size of the grid. Throws as require_page_room() does.
  ClipRecording(const Input& input, const IntervalRange& range, std::size_t more_bytes = 0);

  const ViewGrid& grid() const { return grid_; }

  // Adds the frame in which an interval starts; in order, range.first to range.last.
  void add_frame(const scenes::ClipInterval& interval);
  // Adds another end of the interval that begins at the frame added last: the predicted one, or a pose within
  // the interval that the true motion goes through.
  void add_other_end(std::span<const Vec3> end);

  // Adds the arrays and returns what else the page has to know: counts, grid, and the time of every frame.
  nlohmann::json write(Sections& sections) const;

 private:
  const Input& input_;
  IntervalRange range_;
  ViewGrid grid_;
  PositionCoder frames_{grid_}, ends_{grid_};
  std::vector<float> bones_;  // [frames, bones, head and tail, 3]
  std::size_t added_ = 0;
  std::vector<std::uint32_t> interval_of_end_;  // counted from the range's first
};

}  // namespace cscd::bench
