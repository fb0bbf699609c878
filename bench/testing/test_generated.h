#pragma once

#include <string>

#include "bench/testing/test_program.h"
#include "scenes/character/test_characters.h"
#include "scenes/character/test_figure.h"
#include "scenes/character/test_gltf.h"
#include "scenes/export/glb.h"

// Characters that tests write as files, so that tests over characters also run where the shared models are
// absent.
namespace cscd::bench {

// Names of files; the extension decides the form.
struct GeneratedCharacter {
  const char* name;
  scenes::Character (*make)();
};
inline constexpr GeneratedCharacter kGenerated[] = {
    {"generated_figure.glb", scenes::walking_figure},
    {"generated_figure.gltf", scenes::walking_figure},
    {"generated_tube.gltf", [] { return scenes::bending_tube(); }},
    {"generated_large_tube.glb", [] { return scenes::bending_tube(120, 240); }}};

// Where the character of that name is: a generated one is written into the scratch folder, any other is one
// of the shared models, which may be absent.
inline std::string character_file(const std::string& name, const Scratch& scratch) {
  for (const GeneratedCharacter& generated : kGenerated) {
    if (generated.name != name) continue;
    const scenes::Character character = generated.make();
    write(scratch.path / name,
          name.ends_with(".glb") ? scenes::to_glb(character) : scenes::to_gltf(character));
    return scratch / name;
  }
  return model(name);
}

}  // namespace cscd::bench
