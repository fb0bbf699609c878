#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

namespace cscd::bench {

// What every choice beyond the elementary test buys and costs on a scene, one at a time around the default:
// contacts found, first contacts lost, time of whole intervals.
struct KnobStudy {
  std::size_t every = 1;              // of the scene's intervals, each K-th
  int repetitions = 3;                // of the timing
  std::uint64_t seed = 1;             // of the order of the settings
  std::string elementary = "newton";  // timed; contacts are judged with the exact test
};
nlohmann::ordered_json study_knobs(const std::string& scene, const KnobStudy& study);

}  // namespace cscd::bench
