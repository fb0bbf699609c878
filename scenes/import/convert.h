#pragma once

#include <filesystem>

#include "scenes/character/character.h"
#include "scenes/character/options.h"
#include "scenes/character/report.h"

namespace cscd::scenes {

// Poses a character frame by frame and writes it as a point cache: the chosen components of its welded
// surface, with the bones that move them. Throws InputError for what cannot be made of it, with the counts.
ImportReport convert(const Character& character, const ImportOptions& options, const CharacterLimits& limits,
                     const std::filesystem::path& cache);

}  // namespace cscd::scenes
