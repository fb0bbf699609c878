#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "core/detect/detector.h"

namespace cscd::bench {

// JSON that people and diffs can read: a key a line, but a list without objects or lists in it on one line.
std::string json_text(const nlohmann::ordered_json& value);

// Counters of one interval, keys as the fields are called; radial counters only where the strategy has them.
nlohmann::json counts_json(const Report& report);

// Stage times in milliseconds; a stage that does not exist is absent.
nlohmann::json milliseconds_json(const StageTimes& ms);

}  // namespace cscd::bench
