#include "core/fast/classify/grid_bounds.h"

#include <cmath>

namespace cscd::fast {
namespace {

// The projections of points on the eight directions.
template <class Lanes>
void along_directions(const Lanes (&p)[3], Lanes (&out)[kDirections]) {
  out[0] = p[0], out[1] = p[1], out[2] = p[2];
  out[3] = p[0] + p[1], out[4] = p[0] + p[2], out[5] = p[1] + p[2];
  out[6] = p[0] - p[1], out[7] = p[0] - p[2];
}

// Removes from the mask the triangles that lie on one side of [low, high] at both ends. Axes are tested
// first: asking after every direction whether any triangle is left takes longer than the directions that it
// saves.
template <class Low, class High>
[[gnu::always_inline]] inline Mask16 near_range(const TriangleBounds& triangles, Mask16 mask, const Low& low,
                                                const High& high) {
  static_assert(kDirections == 8);
  const auto apart = [&](std::size_t k) {
    const Mask32 over = above(triangles.low[k], high(k)), under = above(low(k), triangles.high[k]);
    return (over & over >> 1) | (under & under >> 1);
  };
  mask &= static_cast<Mask16>(~first_of_pairs(apart(0) | apart(1) | apart(2)));
  if (mask == 0) return mask;
  return mask & static_cast<Mask16>(~first_of_pairs(apart(3) | apart(4) | apart(5) | apart(6) | apart(7)));
}

}  // namespace

Grid::Grid(float error, float margin)
    : steps_(kSteps * 0x1p-24F / (error + 0x1p-24F * margin)), distance_(2 * margin) {
  if (margin == 0) return;
  // Axes have length 1, the other directions length sqrt(2). Both margins are below 23000 steps, and with the
  // coordinates, which then are fewer steps, below 32100.
  for (std::size_t k = 0; k < kDirections; ++k) {
    const float length = k < 3 ? 1 : 1.41422F;
    const auto grown = static_cast<std::int16_t>(std::ceil(1.0001F * length * margin * steps_));
    for (const std::size_t pair : {k, kDirections + k}) margin_[2 * pair] = margin_[2 * pair + 1] = grown;
  }
}

NodeBounds Grid::bounds_of(const PatchLanes& lanes) const {
  Short32 p[3], along[kDirections];
  for (int i = 0; i < 3; ++i) p[i] = rounded_pairs(lanes.at[0][i], lanes.at[1][i], steps_);
  along_directions(p, along);
  return {smallest_pairs_of_rows(along) - std::int16_t{1} - margin_};
}

TriangleBounds Grid::bounds_of_triangles(const PatchLanes& lanes, const Patch& patch) const {
  Float16 start[kDirections], end[kDirections];
  along_directions(lanes.at[0], start);
  along_directions(lanes.at[1], end);
  TriangleBounds bounds;
  for (std::size_t k = 0; k < kDirections; ++k) {
    const Short32 along = rounded_pairs(start[k], end[k], steps_);
    const Short32 a = permuted_pairs(along, patch.corner[0]), b = permuted_pairs(along, patch.corner[1]),
                  c = permuted_pairs(along, patch.corner[2]);
    const std::int16_t margin = margin_[2 * k];
    bounds.low[k] = smaller(smaller(a, b), c) - margin;
    bounds.high[k] = larger(larger(a, b), c) + static_cast<std::int16_t>(1 + margin);
  }
  return bounds;
}

TriangleBounds swept(const TriangleBounds& bounds) {
  TriangleBounds out;
  for (std::size_t k = 0; k < kDirections; ++k) {
    out.low[k] = smaller(bounds.low[k], turned_pairs(bounds.low[k]));
    out.high[k] = larger(bounds.high[k], turned_pairs(bounds.high[k]));
  }
  return out;
}

Mask16 near(const TriangleBounds& triangles, Mask16 mask, const NodeBounds& other) {
  const Short32 negative = -other.at;
  return near_range(
      triangles, mask, [&](std::size_t k) { return all_pairs(other.at, k); },
      [&](std::size_t k) { return all_pairs(negative, kDirections + k); });
}

Mask16 near(const TriangleBounds& triangles, Mask16 mask, const TriangleBounds& others, std::size_t lane) {
  return near_range(
      triangles, mask, [&](std::size_t k) { return all_pairs(others.low[k], lane); },
      [&](std::size_t k) { return all_pairs(others.high[k], lane); });
}

}  // namespace cscd::fast
