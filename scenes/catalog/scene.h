#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/effects/sequence.h"
#include "scenes/shape/parameters.h"

namespace cscd::scenes {

// The counts and the digest that a scene must have, as far as its file gives them.
struct Expected {
  std::optional<std::size_t> vertices, triangles, bones;
  std::optional<std::string> digest;  // digest of all frames, see FrameDigest
};

// One scene file, scenes/NAME.json or any other path that ends in .json: a shape, the effects that
// move it, and the result that is expected. A scene file may name another scene as its `base` and
// state only the differences. Its `patch` (RFC 6902) changes places in the base, such as
// `/effects/0/weight`. Any other member of the file merges with the base's member if it is an object,
// and replaces the base's member otherwise.
struct Scene {
  std::string name;   // of a scene file by its path: the file's plain name (plain_name.h)
  std::string story;  // two sentences
  std::string shape;
  Parameters shape_parameters;
  std::vector<EffectCall> effects;  // in the order in which they run
  std::size_t frames = 0;
  int substeps = 1;
  std::string
      up;  // the axis that points up, where the file has a member `up` (up_axis.h); no frame depends on it
  Expected expected;
  std::string recipe;  // everything that the frames depend on, in canonical text
};

// One member of a scene file. `type` is a JSON type in words.
struct SceneField {
  std::string_view name, type, meaning;
  bool required = true;
  std::size_t least = 0, most = 0;  // range of a whole number
};
// All members that a scene file may have; parse_scene goes by them.
std::span<const SceneField> scene_fields();

// An entry of list_scenes(): the facts that a scene file states about its scene.
struct SceneSummary {
  std::string name, story;
  std::size_t frames = 0;
  Expected expected;
  std::vector<std::string> effects;
  std::string fault;  // the error if the file is no scene; then only the name is set besides
};

// Returns the folder of scene files: $CSCD_SCENES, or else the nearest folder `scenes` with a scene
// file in it, going up from the current directory and then from the program's own place, or else
// installed_scenes(). Throws InputError if there is none.
std::filesystem::path scenes_folder();

// Returns the folder share/cscd/scenes of the prefix in whose bin/ the program lies, if it holds a scene
// file.
std::optional<std::filesystem::path> installed_scenes();

// Returns all scenes in the order of their names, including those with a fault.
std::vector<SceneSummary> list_scenes();
// Returns the names of all scenes, for `--scene all`. Throws InputError if a scene file has a fault.
std::vector<std::string> all_scene_names();

// Tells whether the argument is the path of a scene file and not a scene's name.
bool is_scene_file(const std::filesystem::path& name_or_path);

// Loads a scene by its name in the folder of scene files, or by the path of its file. Throws InputError for
// an unknown scene, with the nearest name and the folder that was searched, and for a file that is no scene,
// with the place of the fault in the file.
Scene load_scene(std::string_view name_or_path);

// Reads a scene from a text; `where` (a file) begins error texts. A base is looked for in `folder` first.
Scene parse_scene(std::string_view name, const std::string& text, const std::string& where,
                  const std::filesystem::path& folder = {});

}  // namespace cscd::scenes
