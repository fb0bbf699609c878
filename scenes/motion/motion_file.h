#pragma once

#include <filesystem>

#include "scenes/motion/character_motion.h"

namespace cscd::scenes {

// A file by which an import hands over the motion of a character. It is written and read by one build on one
// machine, and numbers stand in it as they lie in memory.
void write_motion(const MovingCharacter& moving, const std::filesystem::path& path);

// Reads such a file. Throws InputError for one that is damaged, is inconsistent (validate), or is about a
// surface of another number of vertices.
MovingCharacter read_motion(const std::filesystem::path& path, std::size_t vertices);

}  // namespace cscd::scenes
