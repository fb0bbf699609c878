#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "scenes/catalog/generate.h"
#include "scenes/catalog/scene.h"
#include "scenes/clip/point_cache.h"

namespace cscd::scenes {

// Returns the text of a scene file with `expected` replaced or added; all four values of `expected` must be
// set. The rest of the text stays as it is written, white space included. `where` begins error texts.
// Throws InputError if `text` is no JSON object.
std::string with_expected(const std::string& text, const Expected& expected, const std::string& where);

// Raise this number when an unchanged scene file gives other frames. Caches of other
// versions are then ignored.
inline constexpr int kGeneratorVersion = 2;

// Returns $CSCD_CACHE, or else `.cache` beside the scenes' folder, or else, as for installed scenes, the
// user's own folder of caches.
std::filesystem::path cache_folder();

// Returns the file in which the frames of this scene are cached. Its name holds a hash of everything that
// the frames depend on.
std::filesystem::path cache_file(const Scene& scene);

// Returns the scene's frames, streamed from its cache. The frames are generated first if the cache is
// missing, and generated again if it is damaged: the cache's digest is verified once for each state of the
// cache file. If several processes miss the same cache, one of them generates it. `progress` is called only
// while frames are generated.
std::unique_ptr<ClipSource> open_scene(const Scene& scene, const Progress& progress = {});

// Returns the names of the scene's bones, [bones]. They are kept beside the cache of its frames, because
// building the shape for their sake can take longer than a query.
std::vector<std::string> bone_names(const Scene& scene);

// Returns the names of the scene's pieces of cloth that no bone carries. They are the last components of its
// mesh, in this order.
std::vector<std::string> cloth_names(const Scene& scene);

// Generates the scene of a file, whatever the file expects, and returns the actual counts and digest. Writes
// them into the file as its `expected`. The file is replaced as a whole, and its other text stays as it was.
Expected accept_scene(const std::filesystem::path& file, const Progress& progress = {});

// Returns the cost of each effect of a scene when its cache was generated. Call open_scene first. Throws
// InputError if the file beside the cache that holds the costs cannot be read.
std::vector<EffectCost> effect_costs(const Scene& scene);

}  // namespace cscd::scenes
