#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace cscd::bench {

// Holds a document against a JSON Schema (draft 7) of this folder, "run.schema.json" or "tables.schema.json".
// Returns the first violation with its place, or an empty text when there is none.
std::string schema_violation(const nlohmann::ordered_json& document, std::string_view schema_file);

}  // namespace cscd::bench
