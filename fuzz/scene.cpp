// Scene files.
#include "scenes/catalog/scene.h"

#include "core/base/error.h"
#include "fuzz/target.h"

namespace cscd::fuzz {

void target(Bytes bytes) {
  try {
    scenes::parse_scene("fuzzed", std::string(bytes.begin(), bytes.end()), "fuzzed.json", "/nowhere");
  } catch (const InputError&) {
  }
}

}  // namespace cscd::fuzz
