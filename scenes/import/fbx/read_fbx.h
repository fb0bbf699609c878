#pragma once

#include <string_view>

#include "scenes/character/character.h"

namespace cscd::scenes {

// Reads an FBX file, binary or text, of version 7100 and later. Objects are identified by their numbers,
// and nodes stand where the FBX SDK puts them. Positions stay in the file's units and axes. Throws
// InputError for damaged files and for content that this reader cannot show as the SDK does. The caller has
// to validate() the character.
Character read_fbx(std::string_view bytes, const CharacterLimits& limits);

}  // namespace cscd::scenes
