#pragma once

#include <CLI/App.hpp>

#include "bench/measure/shards/shard.h"

namespace cscd::bench {

// --cell-seconds and --cell-memory, of the commands that measure cells of a plan. `limits` must live as long
// as the command.
void add_cell_limits(CLI::App& command, CellLimits& limits);

}  // namespace cscd::bench
