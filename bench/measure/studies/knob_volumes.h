#pragma once

#include <span>
#include <string_view>

#include "core/detect/strategy.h"

namespace cscd::bench {

// Plain hierarchies of swept k-DOPs that differ in nothing but the volume, for the study of knobs: number of
// directions, and float rounded outward against double. One plain code for all, so they compare with each
// other and not with the vectorised volumes of the strategies.
struct VolumeRow {
  std::string_view name;
  Prepared (*make)(const StrategyInput& setup);
};
std::span<const VolumeRow> volume_rows();

}  // namespace cscd::bench
