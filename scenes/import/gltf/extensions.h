#pragma once

#include <set>
#include <string>
#include <vector>

namespace cscd::scenes::gltf {

inline constexpr char kMeshopt[] = "EXT_meshopt_compression";
inline constexpr char kDraco[] = "KHR_draco_mesh_compression";
inline constexpr char kPointer[] = "KHR_animation_pointer";

// Throws InputError that names the extension if the file requires an extension that is not read here.
// Extensions that cannot change where vertices are pass.
void require_known(const std::set<std::string>& required);

// Returns one note for each optional extension that is not read and may change where vertices are; a long
// list ends with the number of the others.
std::vector<std::string> notes_on(const std::set<std::string>& used);

}  // namespace cscd::scenes::gltf
