#pragma once

#include <filesystem>

#include "scenes/character/character.h"
#include "scenes/character/options.h"
#include "scenes/character/report.h"

namespace cscd::scenes {

// Writes a moving surface without bones (scenes/exchange/mesh_sequence.h) to `cache` as a point cache, its
// positions as they are, and its source map to `sources`, and returns the report. Triangles that repeat a
// corner are left out, and so are vertices of no triangle. A survey writes the first two frames. Throws
// InputError for options that only a file with clips or bones can follow.
ImportReport import_sequence(const std::filesystem::path& model, const ImportOptions& options,
                             const CharacterLimits& limits, const std::filesystem::path& cache,
                             const std::filesystem::path& sources);

}  // namespace cscd::scenes
