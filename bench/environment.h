#pragma once

#include <nlohmann/json.hpp>

namespace cscd::bench {

// Where and with what a measurement was taken: machine, kernel, compiler, flags, libraries, commit, load,
// date. What the machine does not tell is "unknown", never missing.
nlohmann::ordered_json environment();

}  // namespace cscd::bench
