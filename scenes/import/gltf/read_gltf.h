#pragma once

#include <filesystem>

#include "scenes/character/character.h"

namespace cscd::scenes {

// Reads a glTF 2 file: what its default scene shows, with all clips. Nodes, skins and channels are
// identified by their indices, as the format has it, so equal names do no harm. Two nodes that show one
// mesh make two parts.
//
// Compressed data are decompressed: KHR_draco_mesh_compression, EXT_meshopt_compression. Quantized
// positions are read (KHR_mesh_quantization). Textures are ignored. Other extensions that a file requires
// are refused by name; optional extensions that may move vertices are named in a note.
//
// Throws InputError. The caller has to validate() the result.
Character read_gltf(const std::filesystem::path& path, const CharacterLimits& limits);

}  // namespace cscd::scenes
