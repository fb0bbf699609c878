#pragma once

#include "core/detect/strategy.h"
#include "core/fast/options.h"

namespace cscd {

// Radial view based culling with overlapping covers. Needs a closed, consistently oriented mesh unless it is
// `complete`. Without bones the covers are made from clusters of the surface. With bones, a trial chooses
// between those and the clusters of bones, and how many covers are looked from.
Prepared make_drvbc_fast(const Setup& setup, const DrvbcFastOptions& options = {});

}  // namespace cscd
