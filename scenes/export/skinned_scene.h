#pragma once

#include "scenes/catalog/generate.h"
#include "scenes/character/character.h"

namespace cscd::scenes {

inline constexpr double kExportedFps = 30;  // frames a second; scene files count time in frames

// Makes a character of one part from a scene: the scene's surface at rest, bound to a node for each bone by
// the shape's weights, and one clip with the scene's name and with keys for every bone at every frame.
// Linear blending of the joints gives the scene's frames, turned so that y points up. Memory grows with
// frames x bones and with vertices, and not with frames x vertices.
//
// Throws InputError for a scene whose last effect is not `skinning_linear`, because bones and weights then
// do not determine where the vertices go; for bones that do not stay rigid; and for frames that differ from
// the scene file's digest.
Character skinned_scene(const Scene& scene, const Progress& progress = {});

}  // namespace cscd::scenes
