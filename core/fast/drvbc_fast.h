#pragma once

#include "core/detect/strategy.h"
#include "core/fast/options.h"

namespace cscd {

// Prepares the strategies whose names begin with `drvbc_fast`: radial view based culling with overlapping
// covers. Without bones the covers are made from clusters of the surface. With bones, a trial chooses between
// the clusters of the surface and the clusters of the bones, and chooses the number of covers to look from.
// Throws InputError if the set-up asks for no thread, or if the mesh is not closed and consistently oriented
// and the options do not say `complete`, or say that starts are embedded.
Prepared make_drvbc_fast(const Setup& setup, const DrvbcFastOptions& options = {});

}  // namespace cscd
