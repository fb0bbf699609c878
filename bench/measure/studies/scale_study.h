#pragma once

#include <nlohmann/json.hpp>
#include <random>

#include "bench/measure/studies/scale_input.h"

// One surface, its strategies and its steps, measured for the study of growing work (schema cscd.scale/2).
namespace cscd::bench {

// Builds the surface, makes the strategies, verifies them, then times them interleaved. The result holds
// times only of what was verified; `ok` says whether all was.
nlohmann::ordered_json measure_subject(const ScaleSubject& subject, std::mt19937_64& random);

}  // namespace cscd::bench
