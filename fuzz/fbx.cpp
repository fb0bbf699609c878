// FBX files, binary and text.
#include "core/base/error.h"
#include "scenes/import/fbx/read_fbx.h"

#include "fuzz/target.h"

namespace cscd::fuzz {

void target(Bytes bytes) {
  scenes::CharacterLimits limits;
  limits.vertices = limits.triangles = limits.influences = limits.keys = limits.displacements = 100'000;
  try {
    validate(scenes::read_fbx({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, limits), limits);
  } catch (const InputError&) {
  }
}

}  // namespace cscd::fuzz
