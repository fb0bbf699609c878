#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace cscd::bench {

// JSON that people and diffs can read: a key a line, but a list without objects or lists in it on one line.
std::string json_text(const nlohmann::ordered_json& value);

}  // namespace cscd::bench
