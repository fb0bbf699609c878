#pragma once

#include "core/detect/start/embedding.h"
#include "core/detect/strategy.h"
#include "core/fast/options.h"

namespace cscd {

// Prepares the strategies whose names begin with `drvbc_fast`: radial view based culling with overlapping
// covers. Without bones the covers are made from clusters of the surface. With bones, a trial chooses between
// the clusters of the surface and the clusters of the bones, and chooses the number of covers to look from.
// Throws InputError if the set-up asks for no thread, or if the mesh is not closed and consistently oriented
// and the options do not say `complete`, or say that starts are embedded.
Prepared make_drvbc_fast(const StrategyInput& setup, const DrvbcFastOptions& options = {});

// Prepares the exact test whether a pose is embedded, culled as `drvbc_fast_complete` culls. It takes any
// mesh. The test uses as many threads as the set-up asks for. The mesh of the set-up must outlive the test.
EmbeddingTest make_embedding_test(const StrategyInput& setup);

// The two rows of the engine that the library asks, too.
inline constexpr Strategy kDrvbcFast{
    .name = "drvbc_fast",
    .source = "radial view based culling with overlapping covers",
    .guarantee = Guarantee::first_contact,
    .needs = Needs::closed_mesh,
    .kind = StrategyKind::adaptive,
    .make = [](const StrategyInput& setup) { return make_drvbc_fast(setup); },
    .knows_distance = true,
};
inline constexpr Strategy kDrvbcFastComplete{
    .name = "drvbc_fast_complete",
    .source = "drvbc_fast with a contour test of capped clusters",
    .guarantee = Guarantee::complete,
    .needs = Needs::any_mesh,
    .kind = StrategyKind::adaptive,
    .make =
        [](const StrategyInput& setup) {
          return make_drvbc_fast(setup, {.name = "drvbc_fast_complete", .complete = true});
        },
    .sees_start = true,
    .knows_distance = true,
    .drops_by_signs = true,
};

}  // namespace cscd
