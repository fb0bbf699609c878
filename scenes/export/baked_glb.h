#pragma once

#include <string>

#include "scenes/clip/clip.h"

namespace cscd::scenes {

// Returns a .glb file of any clip, without bones: each frame but the first is a morph target, and an
// animation leads from one to the next in straight lines, as intervals do. Numbers are rounded to single
// precision. Throws InputError where the file would have 4 GiB or more.
std::string baked_glb(ClipSource& clip, const std::string& name, double fps);

}  // namespace cscd::scenes
