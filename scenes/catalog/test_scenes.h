#pragma once

#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "scenes/base/test_says.h"
#include "scenes/catalog/generate.h"
#include "scenes/catalog/scene.h"

namespace cscd::scenes {

// A scene of 82 vertices that is generated in no time, with a wrong digest.
inline const std::string kSmallScene = R"({
  "schema": "cscd.scene/1",
  "story": "A chain falls. It is led by one end.",
  "shape": {"name": "tube", "rings": 10, "sides": 8, "bones": 4, "radius": 1, "length": 20},
  "frames": 6,
  "substeps": 4,
  "effects": [
    {"name": "chain_dynamics", "gravity": [0, 0, -1], "drag": 0.5, "bend_stiffness": 0, "bend_radius": 4,
     "first_end": [[0, 0, 0, 0], [9, 1, 0.5, 2]]},
    {"name": "skinning_linear"}
  ],
  "expected": {"vertices": 82, "triangles": 160, "bones": 4, "digest": "0000000000000000"}
})";

// The small scene with its true digest.
inline std::string small_scene_with_digest() {
  std::optional<Clip> clip;
  const Generated generated =
      run_scene(parse_scene("small", kSmallScene, "small.json"),
                [&](ClipHeader header) -> FrameSink& { return clip.emplace(std::move(header)); });
  std::string text = kSmallScene;
  return text.replace(text.find("0000000000000000"), 16, generated.digest);
}

// The names of the scene files that git tracks, so that a scene of a user's own fails no test. Where git
// tracks none, as in an unpacked archive, all scenes.
inline std::vector<std::string> tracked_scenes() {
  std::vector<std::string> names;
  const std::string list =
      "git -C '" + scenes_folder().string() + "' ls-files -- ':(glob)*.json' 2>/dev/null";
  if (FILE* const pipe = popen(list.c_str(), "r")) {
    char line[256];
    while (std::fgets(line, sizeof line, pipe)) names.push_back(std::filesystem::path(line).stem().string());
    pclose(pipe);
  }
  if (names.empty())
    for (const SceneSummary& scene : list_scenes()) names.push_back(scene.name);
  return names;
}

}  // namespace cscd::scenes
