#pragma once

#include <filesystem>

#include "scenes/character/character.h"
#include "scenes/character/options.h"
#include "scenes/character/report.h"
#include "scenes/character/source_map.h"

namespace cscd::scenes {

// Poses a character frame by frame and writes it to `cache` as a point cache: the chosen components of its
// welded surface, with the bones that move them and the bind pose as the pose at rest. Writes the source
// map of the surface (scenes/character/source_map.h) to `sources`, and returns the report. Throws
// InputError, with the counts, where the character gives no such surface or too many frames.
ImportReport convert(Character character, const ImportOptions& options, const CharacterLimits& limits,
                     const std::filesystem::path& cache, const std::filesystem::path& sources);

// Writes a moving surface without bones (scenes/exchange/mesh_sequence.h), or the one in a folder, to `cache`
// as a point cache, its positions as they are, and its source map to `sources`, and returns the report.
// Triangles that repeat a corner are left out, and so are vertices of no triangle, of which a note says how
// many. A survey writes the first two frames. One pose is written twice where the options take one. Throws
// InputError where they do not, and for options that only a file with clips or bones can follow.
ImportReport import_sequence(const std::filesystem::path& model, const ImportOptions& options,
                             const CharacterLimits& limits, const std::filesystem::path& cache,
                             const std::filesystem::path& sources);

}  // namespace cscd::scenes
