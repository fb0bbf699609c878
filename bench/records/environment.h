#pragma once

#include <nlohmann/json.hpp>

namespace cscd::bench {

// Where and with what a measurement was taken: machine, kernel, compiler, flags, libraries, commit, load,
// date. What the machine does not tell is "unknown", never missing.
nlohmann::ordered_json environment();

// The part of it that is about the program alone: commit, compiler, flags, instruction set, libraries.
nlohmann::ordered_json build_environment();

}  // namespace cscd::bench
