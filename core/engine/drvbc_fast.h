#pragma once

#include <string_view>

#include "core/detect/strategy.h"

namespace cscd {

struct DrvbcFastOptions {
  std::string_view name = "drvbc_fast";  // begins error texts
  // For the ablation.
  std::size_t covers = 3;  // at most
  bool time_linear = true;
  bool stars = true;
  bool planes = true;
  enum class Clusters { by_trial, of_bones, of_surface };  // from which covers are made
  Clusters clusters = Clusters::by_trial;
  // No contact is lost, whatever the surface and the start, by the contour test of capped clusters.
  bool complete = false;

  bool operator==(const DrvbcFastOptions&) const = default;
};

// Radial view based culling with overlapping covers. Needs a closed, consistently oriented mesh unless it is
// `complete`; begins from the clusters of bones or from clusters of the surface, and looks from one cover or
// more: where there are bones, as a trial prefers.
Prepared make_drvbc_fast(const Setup& setup, const DrvbcFastOptions& options = {});

}  // namespace cscd
