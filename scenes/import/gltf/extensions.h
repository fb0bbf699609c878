#pragma once

#include <set>
#include <string>
#include <vector>

namespace cscd::scenes::gltf {

inline constexpr char kMeshopt[] = "EXT_meshopt_compression";
inline constexpr char kDraco[] = "KHR_draco_mesh_compression";
inline constexpr char kPointer[] = "KHR_animation_pointer";

// Throws InputError, by its name, for an extension that a file requires and that is not read here, unless the
// extension cannot change where vertices are.
void require_known(const std::set<std::string>& required);

// One note for each optional extension that is not read and may change where vertices are.
std::vector<std::string> notes_on(const std::set<std::string>& used);

}  // namespace cscd::scenes::gltf
