#pragma once

#include <string>

namespace cscd::bench {

// The version that CMakeLists.txt gives the project, such as "1.2.3".
std::string version_number();

// Returns what this program was built from and with, one line each: version, commit, compiler, instruction
// set, libraries.
std::string version_text();

}  // namespace cscd::bench
