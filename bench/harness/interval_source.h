#pragma once

#include <cstddef>
#include <functional>
#include <utility>

#include "scenes/clip/clip.h"

namespace cscd::bench {

// Intervals that a function gives, so that they need not follow each other. The function may also give
// intervals beyond the last one, which lead up to others (Measurement::Setup).
class IntervalSource final : public scenes::ClipSource {
 public:
  using Load = std::function<scenes::ClipInterval(std::size_t interval)>;

  IntervalSource(scenes::ClipHeader header, std::size_t intervals, Load load)
      : header_(std::move(header)), intervals_(intervals), load_(std::move(load)) {}

  const scenes::ClipHeader& header() const override { return header_; }
  std::size_t frame_count() const override { return intervals_ + 1; }
  scenes::ClipInterval load(std::size_t interval) override { return load_(interval); }
  // Where an interval starts; after the last one, where that ends.
  scenes::FrameView load_frame(std::size_t frame) override {
    const bool is_end = frame == intervals_;
    const scenes::ClipInterval interval = load_(is_end ? frame - 1 : frame);
    const auto bones = interval.bones.value_or(Rig::Interval{});
    return is_end ? scenes::FrameView{interval.motion.end(), bones.end}
                  : scenes::FrameView{interval.motion.start(), bones.start};
  }

 private:
  scenes::ClipHeader header_;
  std::size_t intervals_;
  Load load_;
};

}  // namespace cscd::bench
