#include "core/engine/node_bounds.h"

namespace cscd::fast {

NodeBounds Grid::bounds_of(const PatchLanes& lanes) const {
  Short32 p[3], row[kDirections];
  for (int i = 0; i < 3; ++i) p[i] = rounded_pairs(lanes.at[0][i], lanes.at[1][i], steps_);
  along_directions(p, row);
  return {smallest_pairs_of_rows(row) - std::int16_t{1}};
}

// A step in units is off by 2^-22 of itself, so that the product is by less than 0.012 steps; 1/64 pays for
// that and for the 0.004 above.
MovingBounds Grid::in_units(const NodeBounds& bounds) const {
  const auto pairs = bits_as<Int16>(bounds.at);
  constexpr Float16 kSides = {1, 1, 1, 1, 1, 1, 1, 1, -1, -1, -1, -1, -1, -1, -1, -1};
  const auto units = [&](Int16 steps) { return (converted<Float16>(steps) - 0x1p-6F) * (step_ * kSides); };
  return {{units((pairs << 16) >> 16), units(pairs >> 16)}};
}

}  // namespace cscd::fast
