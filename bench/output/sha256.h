#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace cscd::bench {

// The SHA-256 checksum of bytes, as 64 lower-case hexadecimal digits, as `sha256sum` prints it.
std::string sha256(std::string_view bytes);

// The checksum of a file's content. Throws InputError if the file cannot be read.
std::string sha256_of_file(const std::filesystem::path& path);

}  // namespace cscd::bench
