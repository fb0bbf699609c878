#pragma once

#include <filesystem>
#include <memory>

#include "scenes/catalog/generate.h"
#include "scenes/clip/point_cache.h"

namespace cscd::scenes {

// Raise when the same scene file gives other frames than before: caches of older versions are then left
// alone.
inline constexpr int kGeneratorVersion = 2;

// $CSCD_CACHE, else `.cache` beside the scenes' folder, else the user's own folder of caches.
std::filesystem::path cache_folder();

// Where the frames of this scene are cached: the name holds a hash of what the frames depend on.
std::filesystem::path cache_file(const Scene& scene);

// The scene's frames, streamed from its cache. Generated first where the cache is missing, and again where it
// is damaged: its digest is verified, once for each cache file that has not been changed since. Of several
// processes that miss the same cache, one generates it. `progress` tells of generating only.
std::unique_ptr<ClipSource> open_scene(const Scene& scene, const Progress& progress = {});

// Generates the scene of a file, whatever the file expects of it, and returns what came of it: all four
// values. Writes them into the file, which appears whole with its other text as it was.
Expected accept_scene(const std::filesystem::path& file, const Progress& progress = {});

// What the effects of a scene took when its cache was generated; open_scene first. Throws InputError when the
// file beside the cache that tells cannot be read.
std::vector<EffectCost> effect_costs(const Scene& scene);

}  // namespace cscd::scenes
