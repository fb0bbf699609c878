#pragma once

#include <optional>
#include <span>
#include <string_view>

namespace cscd::scenes::gltf {

// The two pieces of a glTF file: its JSON text, and the binary chunk that only a .glb file has.
struct Container {
  std::string_view json;
  std::optional<std::span<const char>> binary;
};

// Splits a file into its pieces, which point into `file`. The first four bytes tell .glb from .gltf, so
// that a wrong extension does no harm. Throws InputError for a damaged .glb file and for glTF 1.
Container split(std::span<const char> file);

}  // namespace cscd::scenes::gltf
