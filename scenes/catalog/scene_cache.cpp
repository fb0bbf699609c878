#include "scenes/catalog/scene_cache.h"

#include <cstdlib>
#include <optional>

#include "core/base/error.h"
#include "scenes/clip/digest.h"

namespace cscd::scenes {
namespace {

namespace fs = std::filesystem;

// The digest of a point cache; nothing when it cannot be read through.
std::optional<std::string> digest_of(const fs::path& file) {
  std::error_code error;
  if (!fs::exists(file, error)) return std::nullopt;
  try {
    PointCacheReader reader(file);
    DigestSink sink;
    copy_frames(reader, sink);
    return sink.text();
  } catch (const InputError&) {
    return std::nullopt;  // damaged: it is generated again
  }
}

void generate_to_file(const Scene& scene, const fs::path& file, bool force, const Progress& progress) {
  std::optional<PointCacheWriter> writer;
  const Generated generated = run_scene(
      scene, [&](ClipHeader header) -> FrameSink& { return writer.emplace(file, std::move(header), force); },
      progress);
  require_expected_digest(scene, generated.digest);
  writer->finish();
}

}  // namespace

fs::path cache_folder() {
  if (const char* named = std::getenv("CSCD_CACHE")) return named;
  return scenes_folder().parent_path() / ".cache";
}

fs::path cache_file(const Scene& scene) {
  const std::string key = digest(std::to_string(kGeneratorVersion) + scene.recipe);
  return cache_folder() / (scene.name + "-" + key + ".h5");
}

std::unique_ptr<ClipSource> open_scene(const Scene& scene, const Progress& progress) {
  const fs::path file = cache_file(scene);
  if (digest_of(file) != scene.expected.digest) {
    std::error_code error;
    fs::create_directories(file.parent_path(), error);
    if (error)
      throw InputError(file.parent_path().string() + ": cannot be made: " + error.message() +
                       "; let CSCD_CACHE name a folder that can");
    generate_to_file(scene, file, true, progress);
  }
  return std::make_unique<PointCacheReader>(file);
}

void export_scene(const Scene& scene, const fs::path& path, bool force, const Progress& progress) {
  // Opened first: what exists already is refused before the work, not after it.
  std::optional<PointCacheWriter> writer;
  const std::unique_ptr<ClipSource> source = open_scene(scene, progress);
  writer.emplace(path, source->header(), force);
  copy_frames(*source, *writer);
  writer->finish();
}

}  // namespace cscd::scenes
