#pragma once

#include <nlohmann/json.hpp>

// Derives what a record of growing work (schema cscd.scale/2) says beyond its measurements.
namespace cscd::bench {

// Exponents over what a study varies: triangles, bones, threads.
nlohmann::ordered_json fits(const nlohmann::ordered_json& subjects);
// Returns what a step of other length costs, as a ratio to a step of one frame.
nlohmann::ordered_json step_ratios(const nlohmann::ordered_json& subjects);
// Returns what intervals of a scene's variant with contacts cost, as a ratio to the scene's own intervals:
// for the median interval, and for all together.
nlohmann::ordered_json contact_ratios(const nlohmann::ordered_json& subjects);
// Returns what a thickness costs, as ratios to touching alone: of each row, scene and thickness above 0.
nlohmann::ordered_json thickness_ratios(const nlohmann::ordered_json& subjects);

}  // namespace cscd::bench
