#include "scenes/catalog/scene.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "scenes/base/closest_name.h"
#include "scenes/catalog/plain_name.h"
#include "scenes/clip/up_axis.h"

namespace cscd::scenes {
namespace {

using Json = nlohmann::json;
namespace fs = std::filesystem;

constexpr std::uintmax_t kMostBytes = 16 << 20;

constexpr SceneField kFrames{.name = "frames",
                             .type = "whole number",
                             .meaning = "how many frames the scene has; frame 0 is the shape at rest",
                             .least = 2,
                             .most = 100'000'000};
constexpr SceneField kSubsteps{
    .name = "substeps",
    .type = "whole number",
    .meaning = "into how many steps a frame is divided for effects that run in substeps",
    .least = 1,
    .most = 100'000};
constexpr SceneField kFields[] = {
    {.name = "schema", .type = "text", .meaning = "cscd.scene/1"},
    {.name = "story",
     .type = "text",
     .meaning = "what happens, in two sentences, with the units of the scene"},
    {.name = "base",
     .type = "text",
     .meaning =
         "name of a scene, beside the file or in the folder of scenes, whose members this file has where it "
         "does not give them itself; objects are merged (RFC 7396)",
     .required = false},
    {.name = "patch",
     .type = "list of objects",
     .meaning = "changes at places of the base, such as /effects/0/weight (RFC 6902); needs a base",
     .required = false},
    {.name = "shape", .type = "object", .meaning = "name of a shape and the shape's parameters"},
    kFrames,
    kSubsteps,
    {.name = "effects",
     .type = "list of objects",
     .meaning = "for each effect its name and its parameters, in the order in which effects run"},
    {.name = "up",
     .type = "text",
     .meaning = "axis that points up: x, y, z, -x, -y or -z; without it, against the gravity of its effects",
     .required = false},
    {.name = "expected",
     .type = "object",
     .meaning =
         "vertices, triangles, bones and the digest of all frames, which cscd compares with what it makes; "
         "`cscd scene accept FILE` writes them",
     .required = false},
};

// Reads one object of the file, with the object's place for error texts.
class Reader {
 public:
  Reader(const Json& json, std::string where) : json_(json), where_(std::move(where)) {
    if (!json_.is_object()) throw InputError(where_ + ": must be an object");
  }
  const Json& at(const char* key) const {
    const auto found = json_.find(key);
    if (found == json_.end()) throw InputError(where_ + ": " + key + " is missing; add it");
    return *found;
  }
  std::string text(const char* key) const {
    if (!at(key).is_string()) throw InputError(where_ + ": " + key + " must be a text");
    return at(key).get<std::string>();
  }
  std::size_t count(const SceneField& field) const {
    return count(std::string(field.name).c_str(), field.least, field.most);
  }
  std::size_t count(const char* key, std::size_t least, std::size_t most) const {
    const Json& value = at(key);
    if (!value.is_number_unsigned() || value.get<std::size_t>() < least || value.get<std::size_t>() > most)
      throw InputError(where_ + ": " + key + " must be a whole number from " + std::to_string(least) +
                       " to " + std::to_string(most));
    return value.get<std::size_t>();
  }
  template <class Names>
  void only(const Names& known) const {
    for (const auto& [key, value] : json_.items())
      if (std::find(known.begin(), known.end(), key) == known.end())
        throw InputError(where_ + ": " + key + " is unknown; remove it");
  }
  const Json& json() const { return json_; }
  const std::string& where() const { return where_; }

 private:
  const Json& json_;
  std::string where_;
};

// What stands for a value that no parameter can have. Every kind of parameter refuses it, so a misspelt name
// is told before its value.
constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();

Parameters::Value to_value(const Json& json, const std::string& where);

// Returns all entries of an object except the entry `but`.
Parameters to_parameters(const Json& json, const std::string& where, std::string_view but = {}) {
  std::map<std::string, Parameters::Value, std::less<>> values;
  for (const auto& [key, value] : json.items())
    if (key != but) values.emplace(key, to_value(value, where + ": parameter " + key));
  return {where, std::move(values)};
}

bool holds(const Json& list, bool (Json::*kind)() const noexcept) {
  return std::all_of(list.begin(), list.end(), [kind](const Json& item) { return (item.*kind)(); });
}

Parameters::Value to_value(const Json& json, const std::string& where) {
  if (json.is_number()) return json.get<double>();
  if (json.is_string()) return json.get<std::string>();
  if (!json.is_array()) return kNoValue;
  if (holds(json, &Json::is_number)) return json.get<std::vector<double>>();
  if (holds(json, &Json::is_object)) {
    std::vector<Parameters> objects;
    for (const Json& item : json)
      objects.push_back(to_parameters(item, where + " number " + std::to_string(objects.size() + 1)));
    return objects;
  }
  if (!holds(json, &Json::is_array)) return kNoValue;
  for (const Json& row : json)
    if (!holds(row, &Json::is_number)) return kNoValue;
  return json.get<Parameters::Table>();
}

std::string read_text(const fs::path& file) {
  std::error_code error;
  if (!fs::exists(file, error)) throw InputError(file.string() + ": no such file; check the name");
  const std::uintmax_t bytes = fs::is_regular_file(file, error) ? fs::file_size(file, error) : 0;
  std::ifstream stream;
  if (bytes > 0) stream.open(file, std::ios::binary);
  if (bytes == 0) throw InputError(file.string() + ": is empty or not an ordinary file; give a scene file");
  if (error || !stream) throw InputError(file.string() + ": cannot be read; check its permissions");
  if (bytes > kMostBytes) throw InputError(file.string() + ": is larger than 16 MiB; this is no scene file");
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

Json parse_json(const std::string& text, const std::string& where) {
  try {
    return Json::parse(text);
  } catch (const Json::exception& error) {
    throw InputError(where + ": is not JSON: " + error.what());
  }
}

// Joins a scene with its base. The base's file is changed first by the scene's patch (RFC 6902, which
// reaches single items of lists) and then by the scene's other members (RFC 7396: objects merge, anything
// else replaces). Story and digest are never taken from the base.
Json with_base(Json json, const std::string& where, const fs::path& folder) {
  const auto named = json.is_object() ? json.find("base") : json.end();
  if (named == json.end()) return json;
  if (!named->is_string()) throw InputError(where + ": base must be a text");
  const std::string name = named->get<std::string>() + ".json";
  std::error_code ignored;
  const bool beside = !folder.empty() && fs::exists(folder / name, ignored);
  const fs::path file = (beside ? folder : scenes_folder()) / name;
  json.erase(named);
  Json merged = parse_json(read_text(file), file.string());
  if (!merged.is_object()) throw InputError(file.string() + ": must be an object");
  if (merged.contains("base"))
    throw InputError(where + ": its base " + file.string() + " has a base itself; name that");
  merged.erase("story");
  if (merged.contains("expected") && merged["expected"].is_object()) merged["expected"].erase("digest");
  const Json shape_of_base = merged.value("shape", Json());
  if (const auto patch = json.find("patch"); patch != json.end()) {
    try {
      merged.patch_inplace(*patch);
    } catch (const Json::exception& error) {
      throw InputError(where + ": its patch (RFC 6902) does not fit its base " + file.string() + ": " +
                       error.what());
    }
    json.erase(patch);
  }
  merged.merge_patch(json);
  if (merged.value("shape", Json()) != shape_of_base) {  // so the base's counts are of another shape
    merged.erase("expected");
    if (json.contains("expected")) merged["expected"] = json["expected"];
  }
  return merged;
}

Expected read_expected(const Json& json, const std::string& where) {
  constexpr std::size_t most = std::size_t{1} << 28;
  const Reader reader(json, where);
  reader.only(std::array<std::string_view, 4>{"vertices", "triangles", "bones", "digest"});
  Expected expected;
  if (json.contains("vertices")) expected.vertices = reader.count("vertices", 1, most);
  if (json.contains("triangles")) expected.triangles = reader.count("triangles", 1, most);
  if (json.contains("bones")) expected.bones = reader.count("bones", 0, most);
  if (json.contains("digest")) expected.digest = reader.text("digest");
  return expected;
}

std::vector<fs::path> scene_files(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error))
    if (entry.path().extension() == ".json" && entry.is_regular_file(error)) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

std::optional<fs::path> nearest_scenes(fs::path place) {
  for (;; place = place.parent_path()) {
    if (!scene_files(place / "scenes").empty()) return place / "scenes";
    if (!place.has_relative_path()) return std::nullopt;
  }
}

}  // namespace

std::span<const SceneField> scene_fields() {
  return kFields;
}

std::optional<fs::path> installed_scenes() {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  if (error) return std::nullopt;
  const fs::path scenes = program.parent_path().parent_path() / "share" / "cscd" / "scenes";
  if (scene_files(scenes).empty()) return std::nullopt;
  return scenes;
}

fs::path scenes_folder() {
  if (const char* named = std::getenv("CSCD_SCENES")) {
    if (scene_files(named).empty())
      throw InputError(std::string(named) +
                       ": holds no scene file; let CSCD_SCENES name a folder with NAME.json");
    return named;
  }
  std::error_code error;
  const fs::path here = fs::current_path(error);
  if (!error)
    if (const auto found = nearest_scenes(here)) return *found;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  if (!error)
    if (const auto found = nearest_scenes(program.parent_path())) return *found;
  if (const auto found = installed_scenes()) return *found;
  throw InputError(
      "scenes are looked for in a folder scenes/, and there is none here or above; run inside the "
      "repository, let CSCD_SCENES name the folder, or give a file");
}

Scene parse_scene(std::string_view name, const std::string& text, const std::string& where,
                  const fs::path& folder) {
  Json json = with_base(parse_json(text, where), where, folder);
  const Reader reader(json, where);
  if (json.contains("patch"))
    throw InputError(where + ": its patch changes a base, and none is named; add base or remove patch");
  std::vector<std::string_view> known;
  for (const SceneField& field : kFields) known.push_back(field.name);
  // First, since what another kind of file holds is no fault of a scene.
  if (!json.contains("schema"))
    throw InputError(where +
                     ": names no schema, so it is no scene file; cscd list scene-file says what one holds");
  if (reader.text("schema") != "cscd.scene/1") throw InputError(where + ": schema must be cscd.scene/1");
  reader.only(known);

  Scene scene;
  scene.name = name;
  scene.story = reader.text("story");
  const Reader shape(reader.at("shape"), where + ", shape");
  scene.shape = shape.text("name");
  scene.shape_parameters = to_parameters(shape.json(), where + ", shape " + scene.shape, "name");
  scene.frames = reader.count(kFrames);
  scene.substeps = static_cast<int>(reader.count(kSubsteps));

  if (!reader.at("effects").is_array()) throw InputError(where + ": effects must be a list");
  for (const Json& item : reader.at("effects")) {
    const Reader effect(item, where + ", effect number " + std::to_string(scene.effects.size() + 1));
    const std::string effect_name = effect.text("name");
    scene.effects.push_back(
        {effect_name, to_parameters(effect.json(), where + ", effect " + effect_name, "name")});
  }

  if (json.contains("up")) {
    scene.up = reader.text("up");
    if (!is_up_axis(scene.up)) throw InputError(where + ": up must be one of x, y, z, -x, -y, -z");
  }
  if (json.contains("expected")) scene.expected = read_expected(json["expected"], where + ", expected");

  for (const char* without_effect : {"story", "up", "expected"}) json.erase(without_effect);
  scene.recipe = json.dump();
  return scene;
}

bool is_scene_file(const fs::path& name_or_path) {
  return name_or_path.extension() == ".json";
}

Scene load_scene(std::string_view name) {
  if (is_scene_file(name)) {
    const fs::path file(name);
    const fs::path folder = file.has_parent_path() ? file.parent_path() : ".";
    return parse_scene(plain_name(file), read_text(file), file.string(), folder);
  }
  std::vector<std::string> names;
  for (const fs::path& file : scene_files(scenes_folder())) {
    if (file.stem() == name) return parse_scene(name, read_text(file), file.string());
    names.push_back(file.stem().string());
  }
  const std::vector<std::string_view> views(names.begin(), names.end());
  throw InputError("unknown scene " + std::string(name) + did_you_mean(name, views) + "; " +
                   scenes_folder().string() + " holds " + std::to_string(names.size()) +
                   (names.size() == 1 ? " scene" : " scenes") + ", which `cscd list` names");
}

std::vector<SceneSummary> list_scenes() {
  std::vector<SceneSummary> summaries;
  for (const fs::path& file : scene_files(scenes_folder())) {
    SceneSummary& summary = summaries.emplace_back();
    summary.name = file.stem().string();
    try {
      const Scene scene = parse_scene(summary.name, read_text(file), file.string());
      summary.story = scene.story;
      summary.frames = scene.frames;
      summary.expected = scene.expected;
      for (const EffectCall& effect : scene.effects) summary.effects.push_back(effect.name);
    } catch (const InputError& error) {
      summary.fault = error.what();
    }
  }
  return summaries;
}

std::vector<std::string> all_scene_names() {
  std::vector<std::string> names;
  for (const SceneSummary& scene : list_scenes()) {
    if (!scene.fault.empty())
      throw InputError("--scene all: " + scene.fault + " (scene " + scene.name +
                       "); mend or remove that file, or name the scenes one by one");
    names.push_back(scene.name);
  }
  return names;
}

}  // namespace cscd::scenes
