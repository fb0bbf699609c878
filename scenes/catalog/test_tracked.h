#pragma once

#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "scenes/catalog/scene.h"

namespace cscd::scenes {

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
