#pragma once

#include <nlohmann/json.hpp>

namespace cscd::bench {

// What decides which counters and digests this program finds: the commit and the instruction set. A program
// whose sources differ from their commit, or have none, is told apart by a digest of its executable file.
nlohmann::ordered_json code_version();

}  // namespace cscd::bench
