#pragma once

#include <CLI/CLI.hpp>

namespace cscd::bench {

// The commands that write what shells complete and manual pages, from what the program's command line knows.
void add_completion(CLI::App& app);
void add_manual(CLI::App& app);

}  // namespace cscd::bench
