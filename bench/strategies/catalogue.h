#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "core/detect/strategy.h"
#include "core/elementary/catalogue.h"

namespace cscd::bench {

// All strategies. Everything else in the harness goes by their rows.
std::span<const Strategy> strategies();

// Throws InputError that lists the known names.
const Strategy& strategy_named(std::string_view name);
// The rows of a group; those without one for "".
std::vector<const Strategy*> strategies_in(std::string_view group);
// The rows of a group, or one row. Throws InputError that lists the known names.
std::vector<const Strategy*> strategies_called(std::string_view name_or_group);

// All elementary tests: those of the core, and those of packages where they are there.
std::span<const ElementaryTest> all_elementary_tests();
// A row by its name, or one with other parameters: NAME@TOLERANCE or NAME@TOLERANCE:STEPS, as in
// inclusion@1e-4:1000. Lives as long as the program. Throws InputError that lists the known names.
const ElementaryTest& elementary_test_named(std::string_view name);
// Several by names with commas between them; `all` stands for every row.
std::vector<const ElementaryTest*> elementary_tests_named(std::string_view names);

// The simplest complete strategy that is not quadratic: the reference that others are verified against.
const Strategy& complete_reference();

// The fastest complete strategy that takes any surface: the fallback where a surface is not closed or the
// start of an interval not embedded.
const Strategy& complete_fallback();

// All pairs of triangles: the oracle for small meshes.
const Strategy& all_pairs();

}  // namespace cscd::bench
