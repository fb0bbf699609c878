#pragma once

#include "scenes/clip/clip.h"

namespace cscd::scenes {

// Some frames of another clip, which must outlive it; they count from 0.
class ClipPart final : public ClipSource {
 public:
  ClipPart(ClipSource& whole, std::size_t first, std::size_t last)
      : whole_(whole), first_(first), count_(last - first + 1) {}

  const ClipHeader& header() const override { return whole_.header(); }
  std::size_t frame_count() const override { return count_; }
  ClipInterval load(std::size_t interval) override { return whole_.load(first_ + interval); }
  FrameView load_frame(std::size_t frame) override { return whole_.load_frame(first_ + frame); }

 private:
  ClipSource& whole_;
  std::size_t first_, count_;
};

}  // namespace cscd::scenes
