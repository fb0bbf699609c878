#pragma once

#include <string>

#include "bench/cli/interface/command_tree.h"

namespace cscd::bench {

// Scripts that a shell reads, so that it completes the commands, options and values of `cscd`. Names of
// scenes, strategies and tests are asked from the program when they are completed, because scene files may be
// added.
std::string bash_completion(const std::vector<CommandWords>& tree);
std::string zsh_completion(const std::vector<CommandWords>& tree);

}  // namespace cscd::bench
