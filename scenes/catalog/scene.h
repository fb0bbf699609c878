#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/effects/sequence.h"
#include "scenes/shape/parameters.h"

namespace cscd::scenes {

// What a scene must turn out to be.
struct Expected {
  std::size_t vertices = 0, triangles = 0, bones = 0;
  std::string digest;  // of all frames, see FrameDigest
};

// One scene file, scenes/NAME.json: a shape, what moves it, and what comes of it. It may name another as its
// `base` and say only what differs: `patch` (RFC 6902) changes places in it, `/effects/0/weight`; what else
// is said merges with it if it is an object, and replaces it if not.
struct Scene {
  std::string name;
  std::string story;  // two sentences
  std::string shape;
  Parameters shape_parameters;
  std::vector<EffectCall> effects;  // in the order in which they run
  std::size_t frames = 0;
  int substeps = 1;
  Expected expected;
  std::string recipe;  // everything that the frames depend on, in canonical text
};

struct SceneSummary {
  std::string name, story;
  std::size_t frames = 0, vertices = 0, triangles = 0, bones = 0;
  std::vector<std::string> effects;
};

// The folder of scene files: $CSCD_SCENES; else the nearest `scenes` with a scene file in it, going up from
// the current directory, then from the program's own place. Throws InputError when there is none.
std::filesystem::path scenes_folder();

// Scenes in order of their names. Throws InputError for a file that is not a scene.
std::vector<SceneSummary> list_scenes();

// Throws InputError for an unknown scene, listing the known ones, and for a file that is not a scene, naming
// the place in it.
Scene load_scene(std::string_view name);

// The same from a text; `where` (a file) begins the error texts.
Scene parse_scene(std::string_view name, const std::string& text, const std::string& where);

}  // namespace cscd::scenes
