#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/effects/sequence.h"
#include "scenes/shape/parameters.h"

namespace cscd::scenes {

// What a scene must turn out to be, as far as its file says.
struct Expected {
  std::optional<std::size_t> vertices, triangles, bones;
  std::optional<std::string> digest;  // of all frames, see FrameDigest
};

// One scene file, scenes/NAME.json or any other path that ends in .json: a shape, what moves it, and what
// comes of it. It may name another as its `base` and say only what differs: `patch` (RFC 6902) changes places
// in it, `/effects/0/weight`; what else is said merges with it if it is an object, and replaces it if not.
struct Scene {
  std::string name;   // of a scene file by its path, the file's plain name (plain_name.h)
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
  std::size_t frames = 0;
  Expected expected;
  std::vector<std::string> effects;
  std::string fault;  // why the file is no scene; empty if it is one, else nothing but the name is filled in
};

// The folder of scene files: $CSCD_SCENES; else the nearest `scenes` with a scene file in it, going up from
// the current directory, then from the program's own place. Throws InputError when there is none.
std::filesystem::path scenes_folder();

// Scenes in order of their names, those with a fault among them.
std::vector<SceneSummary> list_scenes();

// Whether this is the path of a scene file rather than a scene's name.
bool is_scene_file(const std::filesystem::path& name_or_path);

// A scene by its name in the folder of scene files, or by the path of its file. Throws InputError for an
// unknown scene, listing the known ones, and for a file that is not a scene, naming the place in it.
Scene load_scene(std::string_view name_or_path);

// The same from a text; `where` (a file) begins the error texts. A base is looked for in `folder` first.
Scene parse_scene(std::string_view name, const std::string& text, const std::string& where,
                  const std::filesystem::path& folder = {});

}  // namespace cscd::scenes
