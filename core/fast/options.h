#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace cscd {

// Options of `drvbc_fast`: which of its ideas it uses, and which contacts it promises to keep.
struct DrvbcFastOptions {
  std::string_view name = "drvbc_fast";  // begins error texts
  // Each row of the ablation leaves out one of the next six ideas, or fixes the choice of clusters.
  std::size_t covers = 3;  // the largest number of covers to look from
  bool time_linear =
      true;               // bounds at both ends of the interval (classify/grid_bounds.h); false: swept bounds
  bool one_rings = true;  // certify/one_rings.h
  bool planes = true;     // certify/parting.h
  bool follows = true;    // adaptive_cover.h
  // A step in which the surface moves far is looked at in parts (fast_culler.h) if its descent takes more
  // than this many overlap tests for each patch; kNever: no step is looked at in parts.
  std::uint32_t long_descent = 288;
  static constexpr std::uint32_t kNever = 0xffffffff;
  enum class Clusters { by_trial, of_bones, of_surface };  // the clusters that the covers are made from
  Clusters clusters = Clusters::by_trial;
  // Keeps every contact, on any surface and from any start, by the contour test of capped clusters.
  bool complete = false;
  // With `complete`, on a closed and consistently oriented mesh: takes every start for embedded, and so
  // spares the contour test in intervals without contacts.
  bool starts_embedded = false;

  bool operator==(const DrvbcFastOptions&) const = default;
};

}  // namespace cscd
