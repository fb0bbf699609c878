#pragma once

#include <filesystem>
#include <string>

namespace cscd::scenes {

// What a file is called in records, tables and the names of files that are made of it: the stem of its path,
// at most 64 bytes long. Keeps letters of all alphabets, digits, `.`, `-` and `_`; any other character
// becomes `_`, and so does a first `.` or `-`.
std::string plain_name(const std::filesystem::path& path);

}  // namespace cscd::scenes
