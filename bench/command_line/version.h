#pragma once

#include <string>

namespace cscd::bench {

// "0.1.0"
std::string version_number();

// Returns what this program was built from and with, one line each: version, commit, compiler, instruction
// set, libraries.
std::string version_text();

}  // namespace cscd::bench
