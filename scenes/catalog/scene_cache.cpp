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
#include "core/base/output_target.h"
#include "scenes/catalog/expected_text.h"
#include "scenes/catalog/shapes.h"
#include "scenes/clip/digest.h"

namespace cscd::scenes {
namespace {

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

fs::path costs_file(const Scene& scene) {
  return cache_file(scene).replace_extension(".effects.json");
}

// The file with the digest of the cached frames, for a scene whose own file has none.
fs::path digest_file(const Scene& scene) {
  return cache_file(scene).replace_extension(".digest");
}

void write_whole(const fs::path& path, const std::string& text) {
  UnfinishedFile file(path, true);
  file.write(text);
  file.finish();
}

void write_costs(const Scene& scene, const Generated& generated) {
  auto effects = nlohmann::ordered_json::array();
  for (const EffectCost& effect : generated.effects)
    effects.push_back({{"name", effect.name}, {"evaluations", effect.evaluations}, {"ms", effect.ms}});
  write_whole(costs_file(scene), effects.dump(1) + "\n");
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

std::string first_line(const fs::path& path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  return line;
}

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
  std::error_code error;
  if (!fs::exists(costs_file(scene), error)) return false;
  const std::string right = scene.expected.digest.value_or(first_line(digest_file(scene)));
  const fs::path verified = cache_file(scene).replace_extension(".verified");
  const std::string now = right + " " + identity_of(cache_file(scene));
  if (right.empty()) return false;
  if (first_line(verified) == now) return true;
  if (digest_of(cache_file(scene)) != right) return false;
  try {
    write_whole(verified, now + "\n");
  } catch (const InputError&) {
    // Where nothing can be written, the digest is computed every time.
  }
  return true;
}

void generate_to_cache(const Scene& scene, const Progress& progress) {
  const fs::path file = cache_file(scene);
  std::optional<PointCacheWriter> writer;
  const Generated generated = run_scene(
      scene, [&](ClipHeader header) -> FrameSink& { return writer.emplace(file, std::move(header), true); },
      progress);
  require_expected_digest(scene, generated.digest);
  write_costs(scene, generated);
  if (!scene.expected.digest) write_whole(digest_file(scene), generated.digest + "\n");
  writer->finish();
}

}  // namespace

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
  const fs::path file = cache_file(scene).replace_extension(".bones.json");
  try {
    std::ifstream stream(file);
    return nlohmann::json::parse(stream).get<std::vector<std::string>>();
  } catch (const nlohmann::json::exception&) {
    // There is no such file yet, or it is damaged.
  }
  std::vector<std::string> names = make_shape(scene.shape, scene.shape_parameters).bone_names;
  try {
    write_whole(file, nlohmann::json(names).dump() + "\n");
  } catch (const InputError&) {
    // Where nothing can be written, the shape is built every time.
  }
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
  write_whole(target.path, with_expected(text, found, file.string()));
  return found;
}

std::vector<EffectCost> effect_costs(const Scene& scene) {
  const fs::path file = costs_file(scene);
  std::vector<EffectCost> costs;
  try {
    std::ifstream stream(file);
    for (const nlohmann::json& effect : nlohmann::json::parse(stream))
      costs.push_back({effect.at("name"), effect.at("evaluations"), effect.at("ms")});
  } catch (const nlohmann::json::exception& error) {
    throw InputError(file.string() + ": cannot be read (" + error.what() +
                     "); remove it, and the scene is generated anew");
  }
  return costs;
}

}  // namespace cscd::scenes
