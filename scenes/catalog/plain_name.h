#pragma once

#include <filesystem>
#include <string>

namespace cscd::scenes {

// Returns the name that a file has in records, in tables and in the names of files made from it: the stem
// of its path, cut to at most 64 bytes. Letters of all alphabets, digits, `.`, `-` and `_` stay. Any other
// character becomes `_`, and so does a first `.` or `-`.
std::string plain_name(const std::filesystem::path& path);

}  // namespace cscd::scenes
