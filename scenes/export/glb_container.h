#pragma once

#include <string>

namespace cscd::scenes {

// Returns a .glb file of a glTF document and the bytes of its one buffer, whose number is a multiple of four
// (glTF 2.0, section 4.4). Throws InputError for 4 GiB or more.
std::string glb_container(const std::string& json, const std::string& binary);

}  // namespace cscd::scenes
