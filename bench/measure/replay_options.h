#pragma once

#include <CLI/App.hpp>

#include "bench/measure/replay/replay.h"

namespace cscd::bench {

// The options of `cscd run` that say what is measured. `request` must live as long as the command.
void add_replay_options(CLI::App& command, ReplayRequest& request);

}  // namespace cscd::bench
