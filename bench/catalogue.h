#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "core/detect/strategy.h"

namespace cscd::bench {

// All strategies. Everything else in the harness goes by their rows.
std::span<const Strategy> strategies();

// Throws InputError that lists the known names.
const Strategy& strategy_named(std::string_view name);
// The rows of a group; those without one for "".
std::vector<const Strategy*> strategies_in(std::string_view group);
const ElementaryTest& elementary_test_named(std::string_view name);

// The complete strategy with the fewest demands that is not quadratic: what stands in where the start of an
// interval is not embedded, and the reference that others are verified against.
const Strategy& complete_reference();

// All pairs of triangles: the oracle for small meshes.
const Strategy& all_pairs();

}  // namespace cscd::bench
