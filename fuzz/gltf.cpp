// glTF files, text and binary.
#include "core/base/error.h"
#include "fuzz/target.h"
#include "scenes/import/gltf/read_gltf.h"

namespace cscd::fuzz {

void target(Bytes bytes) {
  const InputFile file(bytes);
  scenes::CharacterLimits limits;
  limits.vertices = limits.triangles = limits.influences = limits.keys = limits.displacements = 100'000;
  try {
    validate(scenes::read_gltf(file.path(), limits), limits);
  } catch (const InputError&) {
  }
}

}  // namespace cscd::fuzz
