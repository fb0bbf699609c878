#pragma once

#include <string>

namespace cscd::bench {

// "0.1.0"
std::string version_number();

// What this program was built from and with: version, commit, compiler, instruction set, libraries; a line
// each.
std::string version_text();

}  // namespace cscd::bench
