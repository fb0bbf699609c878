#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace cscd::bench {

// The extension of an output's name decides the format that is written. Returns it in lower case with its
// dot, one of `known` (".h5", ".glb", ...). Throws InputError, which lists the known ones, for any other
// extension and for a name without one.
std::string require_format(const std::filesystem::path& output, std::span<const std::string_view> known);

}  // namespace cscd::bench
