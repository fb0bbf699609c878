#pragma once

#include "core/detect/strategy.h"

namespace cscd {

// Prepares the strategy `drvbc_fast_near`: drvbc_fast_complete, which answers small steps from a list of the
// pairs that are near each other (NearPairs), as a Session with such a list does.
Prepared make_drvbc_fast_near(const StrategyInput& setup);

inline constexpr Strategy kDrvbcFastNear{
    .name = "drvbc_fast_near",
    .source = "drvbc_fast_complete that answers small steps from the pairs that are near",
    .guarantee = Guarantee::complete,
    .needs = Needs::any_mesh,
    .kind = StrategyKind::adaptive,
    .make = make_drvbc_fast_near,
    .group = "small_steps",
    .knows_distance = true,
};

}  // namespace cscd
