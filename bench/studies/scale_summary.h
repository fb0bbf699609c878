#pragma once

#include <nlohmann/json.hpp>

// What a record of growing work (schema cscd.scale/1) says beyond its measurements; all of it follows from
// its subjects.
namespace cscd::bench {

// Exponents over what a study varies: triangles, bones, threads.
nlohmann::ordered_json fits(const nlohmann::ordered_json& subjects);
// What a step of other length costs against one of a frame.
nlohmann::ordered_json step_ratios(const nlohmann::ordered_json& subjects);
// What intervals of a scene's variant with contacts cost against its own: the median one, and all together.
nlohmann::ordered_json contact_ratios(const nlohmann::ordered_json& subjects);

}  // namespace cscd::bench
