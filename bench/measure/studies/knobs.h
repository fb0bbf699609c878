#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

namespace cscd::bench {

// Measures what every choice beyond the elementary test buys and costs on a scene, one choice at a time
// around the default: contacts found, first contacts lost, time of whole intervals. Every setting uses the
// test `filtered_exact`, whose answers are the referee's.
struct KnobStudy {
  std::size_t every = 1;       // of the scene's intervals, each K-th,
  std::size_t colliding = 12;  // and so many of those with contacts, at even distances
  int repetitions = 3;         // of the timing
  std::uint64_t seed = 1;      // of the order of the settings
};
nlohmann::ordered_json study_knobs(const std::string& scene, const KnobStudy& study);

}  // namespace cscd::bench
