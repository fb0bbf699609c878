#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/vec3.h"

namespace cscd::bench {

// A cubic grid of 2^16 places a side over a box, for positions that are only looked at.
class ViewGrid {
 public:
  void include(std::span<const Vec3> positions);  // grows the box

  Vec3 origin() const { return low_; }
  double step() const;  // between neighbouring places, in lengths of the scene; positive
  // Appends the place nearest to each position: all x, all y, then all z.
  void append_places(std::span<const Vec3> positions, std::vector<std::uint16_t>& places) const;

 private:
  Vec3 low_ = Vec3::Constant(1e300), high_ = Vec3::Constant(-1e300);
};

// Codes the places of frame after frame as bytes that compress well. Each frame is one byte that names the
// predictor, then the low bytes and then the high bytes of what the predictor misses by. Predictor 0 is no
// prediction in time, 1 the last frame, 2 a straight line through the last two frames; for each frame the
// coder takes the one that misses least. What is missed is coded as its difference from that of the vertex
// before, as neighbours move alike, with the sign in the lowest bit. All sums are modulo 2^16.
class PositionCoder {
 public:
  explicit PositionCoder(const ViewGrid& grid) : grid_(grid) {}

  void append(std::span<const Vec3> positions);
  const std::vector<std::uint8_t>& bytes() const { return bytes_; }

 private:
  void code(std::uint8_t predictor, std::vector<std::uint16_t>& missed) const;

  const ViewGrid& grid_;
  std::size_t frames_ = 0;
  std::array<std::vector<std::uint16_t>, 3> last_;  // the newest frame first
  std::array<std::vector<std::uint16_t>, 3> trial_;
  std::vector<std::uint8_t> bytes_;
};

}  // namespace cscd::bench
