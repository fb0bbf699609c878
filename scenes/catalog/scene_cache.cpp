#include "scenes/catalog/scene_cache.h"

#include <cstdlib>
#include <fcntl.h>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <optional>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/base/error.h"
#include "scenes/base/output_target.h"
#include "scenes/catalog/shapes.h"
#include "scenes/clip/digest.h"

namespace cscd::scenes {

namespace {

using OrderedJson = nlohmann::ordered_json;

// A half-open range of bytes; empty where nothing was found.
struct Span {
  std::size_t begin = 0, end = 0;
};

// Finds the value of the last member `expected` of the outermost object, in a text that is known to be JSON.
Span find_value(const std::string& text) {
  Span found;
  std::size_t depth = 0, key_begin = 0, value_begin = 0;
  bool in_text = false;
  std::string key;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (in_text) {
      if (c == '\\') ++i;
      if (c != '"') continue;
      in_text = false;
      if (value_begin == 0) key = text.substr(key_begin, i - key_begin);
      continue;
    }
    if (c == '"') in_text = true, key_begin = i + 1;
    if (c == ':' && depth == 1) value_begin = text.find_first_not_of(" \t\r\n", i + 1);
    const bool closes = c == '}' || c == ']';
    if ((c == ',' || closes) && depth == 1) {
      if (value_begin != 0 && key == "expected")
        found = {value_begin, text.find_last_not_of(" \t\r\n", i - 1) + 1};
      value_begin = 0;
    }
    if (c == '{' || c == '[') ++depth;
    if (closes) --depth;
  }
  return found;
}

namespace fs = std::filesystem;

// Returns the digest of a point cache, or nullopt if the cache cannot be read to its end.
std::optional<std::string> digest_of(const fs::path& file) {
  std::error_code error;
  if (!fs::exists(file, error)) return std::nullopt;
  try {
    PointCacheReader reader(file);
    DigestSink sink;
    copy_frames(reader, sink);
    return sink.text();
  } catch (const InputError&) {
    return std::nullopt;  // a damaged cache is generated again
  }
}

// What is known of cached frames, in one file beside them.
struct CacheNotes {
  std::vector<EffectCost> effects;
  std::vector<std::string> bones;
  std::string digest;    // of the frames when they were generated
  std::string verified;  // identity_of() the cache when its digest was last found right
};

fs::path notes_file(const Scene& scene) {
  return cache_file(scene).replace_extension(".json");
}

void write_notes(const Scene& scene, const CacheNotes& notes) {
  auto effects = nlohmann::ordered_json::array();
  for (const EffectCost& effect : notes.effects)
    effects.push_back({{"name", effect.name}, {"evaluations", effect.evaluations}, {"ms", effect.ms}});
  const nlohmann::ordered_json json{
      {"effects", effects}, {"bones", notes.bones}, {"digest", notes.digest}, {"verified", notes.verified}};
  UnfinishedFile file(notes_file(scene), true);
  file.write(json.dump(1) + "\n");
  file.finish();
}

// Returns nullopt where there is no such file, or a damaged one.
std::optional<CacheNotes> read_notes(const Scene& scene) {
  CacheNotes notes;
  try {
    std::ifstream stream(notes_file(scene));
    const nlohmann::json json = nlohmann::json::parse(stream);
    for (const nlohmann::json& effect : json.at("effects"))
      notes.effects.push_back({effect.at("name"), effect.at("evaluations"), effect.at("ms")});
    json.at("bones").get_to(notes.bones);
    json.at("digest").get_to(notes.digest);
    json.at("verified").get_to(notes.verified);
  } catch (const nlohmann::json::exception&) {
    return std::nullopt;
  }
  return notes;
}

// A lock that is held while a cache is checked and generated. The system releases it when the process ends.
class CacheLock {
 public:
  explicit CacheLock(const fs::path& cache)
      : file_(open(cache.string().append(".lock").c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0666)) {
    if (file_ >= 0) flock(file_, LOCK_EX);  // without the lock, a cache is only generated twice
  }
  ~CacheLock() {
    if (file_ >= 0) close(file_);
  }
  CacheLock(const CacheLock&) = delete;
  CacheLock& operator=(const CacheLock&) = delete;

 private:
  int file_;
};

// Identifies a file with its size and the times of its last changes. The system sets the time of status
// change, so anything that writes to the file changes that time.
std::string identity_of(const fs::path& path) {
  struct stat facts {};
  if (stat(path.c_str(), &facts) != 0) return {};
  const auto nanoseconds = [](const timespec& t) {
    return std::to_string(t.tv_sec) + "." + std::to_string(t.tv_nsec);
  };
  return std::to_string(facts.st_dev) + " " + std::to_string(facts.st_ino) + " " +
         std::to_string(facts.st_size) + " " + nanoseconds(facts.st_mtim) + " " + nanoseconds(facts.st_ctim);
}

// Tells whether the scene's cache is complete. Reading all frames for their digest takes longer than many a
// query, so it is done once for each file: a cache whose digest was right once, and which has not been
// changed since, is complete.
bool is_whole(const Scene& scene) {
  std::optional<CacheNotes> notes = read_notes(scene);
  if (!notes || notes->digest != scene.expected.digest.value_or(notes->digest)) return false;
  const std::string now = identity_of(cache_file(scene));
  if (notes->verified == now && !now.empty()) return true;
  if (digest_of(cache_file(scene)) != notes->digest) return false;
  notes->verified = now;
  try {
    write_notes(scene, *notes);
  } catch (const InputError&) {
    // Where nothing can be written, the digest is computed every time.
  }
  return true;
}

void generate_to_cache(const Scene& scene, const Progress& progress) {
  const fs::path file = cache_file(scene);
  std::optional<PointCacheWriter> writer;
  Generated generated = run_scene(
      scene, [&](ClipHeader header) -> FrameSink& { return writer.emplace(file, std::move(header), true); },
      progress);
  require_expected_digest(scene, generated.digest);
  write_notes(scene, {std::move(generated.effects), std::move(generated.bone_names), generated.digest, {}});
  writer->finish();
}

}  // namespace

std::string with_expected(const std::string& text, const Expected& expected, const std::string& where) {
  try {
    OrderedJson wanted = OrderedJson::parse(text);
    if (!wanted.is_object()) throw InputError(where + ": must be an object");
    wanted["expected"] = {{"vertices", expected.vertices.value()},
                          {"triangles", expected.triangles.value()},
                          {"bones", expected.bones.value()},
                          {"digest", expected.digest.value()}};
    const std::string value = "{\"vertices\": " + std::to_string(*expected.vertices) +
                              ", \"triangles\": " + std::to_string(*expected.triangles) +
                              ", \"bones\": " + std::to_string(*expected.bones) +
                              ", \"digest\": " + OrderedJson(*expected.digest).dump() + "}";
    std::string changed = text;
    if (const Span old = find_value(text); old.end > 0) {
      changed.replace(old.begin, old.end - old.begin, value);
    } else {
      const std::size_t brace = text.rfind('}'), last = text.find_last_not_of(" \t\r\n", brace - 1);
      const bool first_member = text[last] == '{';
      changed.insert(last + 1, std::string(first_member ? "" : ",") + "\n  \"expected\": " + value);
    }
    // If the edited text does not have the wanted meaning, because the file is written in an unforeseen
    // way, the whole text is written anew: the file loses its white space and keeps its meaning.
    return OrderedJson::parse(changed, nullptr, false) == wanted ? changed : wanted.dump(2) + "\n";
  } catch (const OrderedJson::exception& error) {
    throw InputError(where + ": is not JSON: " + error.what());
  }
}

fs::path cache_folder() {
  if (const char* named = std::getenv("CSCD_CACHE"); named != nullptr && *named != '\0') return named;
  std::string no_scenes;
  try {
    const fs::path scenes = scenes_folder();
    if (scenes != installed_scenes()) return scenes.parent_path() / ".cache";
  } catch (const InputError& error) {  // a scene file may lie anywhere
    no_scenes = error.what();
  }
  if (const char* caches = std::getenv("XDG_CACHE_HOME")) return fs::path(caches) / "cscd";
  if (const char* home = std::getenv("HOME")) return fs::path(home) / ".cache" / "cscd";
  throw InputError(no_scenes.empty() ? "no folder for frames; let CSCD_CACHE or HOME name one" : no_scenes);
}

fs::path cache_file(const Scene& scene) {
  const std::string key = digest(std::to_string(kGeneratorVersion) + scene.recipe);
  return cache_folder() / (scene.name + "-" + key + ".h5");
}

std::unique_ptr<ClipSource> open_scene(const Scene& scene, const Progress& progress) {
  const fs::path file = cache_file(scene);
  if (!is_whole(scene)) {
    std::error_code error;
    fs::create_directories(file.parent_path(), error);
    if (error)
      throw InputError(file.parent_path().string() + ": cannot be made: " + error.message() +
                       "; let CSCD_CACHE name a folder that can");
    const CacheLock lock(file);
    try {
      if (!is_whole(scene)) generate_to_cache(scene, progress);  // unless another process has meanwhile
    } catch (const OutputError& refused) {
      throw OutputError(
          std::string(refused.what()) + "; or let CSCD_CACHE name a folder that can be written to",
          refused.reason);
    }
  }
  return std::make_unique<PointCacheReader>(file);
}

std::vector<std::string> bone_names(const Scene& scene) {
  if (std::optional<CacheNotes> notes = read_notes(scene)) return std::move(notes->bones);
  return make_shape(scene.shape, scene.shape_parameters).bone_names;
}

std::vector<std::string> cloth_names(const Scene& scene) {
  if (!scene.shape_parameters.has("skirts")) return {};
  const std::size_t count = scene.shape_parameters.objects("skirts").size();
  if (count == 1) return {"skirt"};
  std::vector<std::string> names;
  for (std::size_t i = 0; i < count; ++i) names.push_back("skirt " + std::to_string(i));
  return names;
}

Expected accept_scene(const fs::path& file, const Progress& progress) {
  Scene scene = load_scene(file.string());
  const OutputTarget target = find_output_target(file, true);
  scene.expected = {};
  const std::unique_ptr<ClipSource> source = open_scene(scene, progress);
  DigestSink digest;
  copy_frames(*source, digest);
  const ClipHeader& header = source->header();
  const Expected found{header.vertex_count, header.triangles.size(), header.bone_parent.size(),
                       digest.text()};
  std::ifstream stream(target.path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  UnfinishedFile out(target.path, true);
  out.write(with_expected(text, found, file.string()));
  out.finish();
  return found;
}

std::vector<EffectCost> effect_costs(const Scene& scene) {
  if (std::optional<CacheNotes> notes = read_notes(scene)) return std::move(notes->effects);
  throw InputError(notes_file(scene).string() +
                   ": cannot be read; remove it, and the scene is generated anew");
}

}  // namespace cscd::scenes
