#pragma once

#include <filesystem>

#include "scenes/character/character.h"

namespace cscd::scenes {

// Reads a model file: glTF with tinygltf (gltf/read_gltf.h), FBX with a reader of this project's own
// (fbx/read_fbx.h), and the other formats with assimp. Call it in a process that may be lost, because
// readers of untrusted bytes crash now and then. Throws InputError for formats outside the short list
// below, for files that their reader refuses, and for characters that validate() refuses.
//
// The list holds glTF 2, FBX, Collada, DirectX X, and BVH (which holds no surface and is read to say so).
// Other formats of assimp can hold skinned characters too, but each importer is one more reader of
// untrusted bytes.
Character read_model(const std::filesystem::path& path, const CharacterLimits& limits);

}  // namespace cscd::scenes
