#pragma once

#include <string>
#include <string_view>

#include "scenes/character/character.h"
#include "scenes/character/transform.h"
#include "scenes/clip/clip.h"

namespace cscd::scenes {

// Returns a .glb file of a glTF document and the bytes of its one buffer, whose number is a multiple of four
// (glTF 2.0, section 4.4). Throws InputError for 4 GiB or more.
std::string glb_container(const std::string& json, const std::string& binary);

// The rotation that brings an axis (clip/up_axis.h) to y, which points up in glTF (3.4).
Quaternion turn_to_y(std::string_view up);

// Returns the bytes of a binary glTF 2.0 file of a character. The file has a node for each node, with a
// mesh of one primitive for each part, as many sets of four joints and weights as the part's vertices need,
// a skin for each part with joints, and an animation with linear keys for each clip. Numbers are rounded to
// single precision.
//
// Throws InputError for characters that validate() refuses and for what this writer cannot express: numbers
// beyond single precision, keys whose times become equal by rounding, keys that are not joined by straight
// lines, morph targets, vertices without a joint in a part with joints, sheared nodes, parts without
// triangles, clips that move nothing, and files of 4 GiB or more.
std::string to_glb(const Character& character);

// Returns a .glb file of any clip, without bones: each frame but the first is a morph target, and an
// animation leads from one to the next in straight lines, as intervals do. It begins when frame `first_frame`
// is shown, which is not negative; frame 0 is at 0 seconds. Numbers are rounded to single precision. A node
// turns the axis `up` to y and scales by `metres_per_unit`, because lengths are metres in glTF. Throws
// InputError where the file would have 4 GiB or more.
std::string baked_glb(ClipSource& clip, const std::string& name, double fps, double first_frame,
                      const std::string& up, double metres_per_unit);

}  // namespace cscd::scenes
