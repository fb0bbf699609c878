#pragma once

#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <vector>

#include "bench/input.h"
#include "core/detect/strategy.h"
#include "scenes/catalog/resized.h"

// One surface, its strategies and its steps, measured for the study of growing work (schema cscd.scale/1).
namespace cscd::bench {

struct ScaleSubject {
  std::string study;                // size, step, bones or threads
  std::size_t triangles = 0;        // asked for; 0 for the scene's own
  std::size_t bones = 0;            // of the chain; 0 for the scene's own
  std::vector<double> steps;        // in frame steps: a whole number, or a share of one
  std::vector<std::size_t> starts;  // frames at which intervals start
  std::vector<const Strategy*> strategies;
  std::size_t repetitions = 5;
  int threads = 1;  // for the strategies that can share their work
  std::size_t reference_limit =
      0;  // triangles above which the complete reference answers one interval a step
};

// Frames that the subjects of a scene need, and the poses there.
struct PosedScene {
  scenes::Scene scene;
  std::vector<scenes::Pose> poses;
};
PosedScene pose_scene(const std::string& name, std::span<const double> steps,
                      std::span<const std::size_t> starts);

// So many frames, spread evenly, from each of which the longest step stays inside the clip. Throws InputError
// where there is no room.
std::vector<std::size_t> spread_starts(std::size_t frames, std::size_t count, double longest_step);

// Builds the surface, makes the strategies, verifies them, then times them interleaved. The result holds
// times only of what was verified; `ok` says whether all was.
nlohmann::ordered_json measure_subject(const PosedScene& posed, const ScaleSubject& subject,
                                       std::mt19937_64& random);

}  // namespace cscd::bench
