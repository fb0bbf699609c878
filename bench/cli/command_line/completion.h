#pragma once

#include <span>
#include <string>

#include "bench/cli/command_line/command_tree.h"

namespace cscd::bench {

// A script that lets bash complete commands, options, and the names of scenes, strategies and elementary
// tests.
std::string bash_completion(std::span<const CommandRow> commands);

}  // namespace cscd::bench
