#pragma once

#include <filesystem>

#include "scenes/character/character.h"
#include "scenes/character/options.h"
#include "scenes/character/report.h"
#include "scenes/character/source_map.h"

namespace cscd::scenes {

// Poses a character frame by frame and writes it as a point cache: the chosen components of its welded
// surface, with the bones that move them and the bind pose as the pose at rest. Where its vertices come from
// goes to a file of its own. Throws InputError for what cannot be made of it, with the counts.
ImportReport convert(const Character& character, const ImportOptions& options, const CharacterLimits& limits,
                     const std::filesystem::path& cache, const std::filesystem::path& sources);

}  // namespace cscd::scenes
