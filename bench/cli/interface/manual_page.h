#pragma once

#include <string>

#include "bench/cli/interface/command_tree.h"

namespace cscd::bench {

// The name of a command's manual page, such as "cscd-benchmark-make".
std::string manual_page_name(const CommandWords& command);

// Returns the manual page of a command in the language of man(7): what its --help says.
std::string manual_page(const std::vector<CommandWords>& tree, const CommandWords& command);

}  // namespace cscd::bench
