// FBX files, binary and text: they are read, and posed within their clips and far beyond.
#include "core/base/error.h"
#include "fuzz/target.h"
#include "scenes/character/pose.h"
#include "scenes/import/fbx/read_fbx.h"

namespace cscd::fuzz {

void target(Bytes bytes) {
  scenes::CharacterLimits limits;
  limits.vertices = limits.triangles = limits.influences = limits.keys = limits.displacements = 100'000;
  try {
    const scenes::Character character =
        scenes::read_fbx({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, limits);
    validate(character, limits);
    std::vector<Vec3> positions;
    for (const scenes::Animation& clip : character.animations)
      for (const double seconds : {clip.start + clip.seconds / 3, clip.start + clip.seconds, -1e9, 1e9})
        skin(character, pose_at(character, clip, seconds), weights_at(character, clip, seconds), positions);
  } catch (const InputError&) {
  }
}

}  // namespace cscd::fuzz
