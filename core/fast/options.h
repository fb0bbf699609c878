#pragma once

#include <cstddef>
#include <string_view>

namespace cscd {

// What may be left out of `drvbc_fast`, and what it promises.
struct DrvbcFastOptions {
  std::string_view name = "drvbc_fast";  // begins error texts
  // Rows of the ablation leave one idea out each.
  std::size_t covers = 3;  // the largest number of covers to look from
  bool time_linear = true;
  bool stars = true;
  bool planes = true;
  enum class Clusters { by_trial, of_bones, of_surface };  // what the covers are made from
  Clusters clusters = Clusters::by_trial;
  // Keeps every contact, on any surface and from any start, by the contour test of capped clusters.
  bool complete = false;

  bool operator==(const DrvbcFastOptions&) const = default;
};

}  // namespace cscd
