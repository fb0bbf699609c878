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

// Tells .glb from .gltf by the first four bytes, so that a wrong extension does no harm. The pieces point
// into `file`. Throws InputError for a damaged .glb file and for glTF 1.
Container split(std::span<const char> file);

}  // namespace cscd::scenes::gltf
