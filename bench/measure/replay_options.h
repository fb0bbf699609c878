#pragma once

#include <CLI/App.hpp>

#include "bench/measure/replay/replay.h"

namespace cscd::bench {

// The options that say what is measured, of `cscd run` and of `cscd plan`. `request` must live as long as the
// command.
void add_replay_options(CLI::App& command, ReplayRequest& request);

}  // namespace cscd::bench
