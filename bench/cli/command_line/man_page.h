#pragma once

#include <span>
#include <string>

#include "bench/cli/command_line/command_tree.h"

namespace cscd::bench {

// The manual page of the program, for man(1).
std::string man_page(std::span<const CommandRow> commands, const std::string& version);

}  // namespace cscd::bench
