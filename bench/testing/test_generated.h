#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "bench/testing/test_program.h"
#include "scenes/character/test_characters.h"
#include "scenes/character/test_figure.h"
#include "scenes/character/test_gltf.h"
#include "scenes/export/glb.h"

// Characters that tests write as files, so that tests over characters also run where the shared models are
// absent.
namespace cscd::bench {

// The bending tube with so many triangles that reading it takes a while.
inline scenes::Character large_tube() {
  scenes::Character tube = scenes::bending_tube();
  scenes::Part& part = tube.parts[0];
  const test::Shape surface = test::capped_tube(120, 240, 0.5, 4);
  part.positions = surface.positions;
  part.triangles.clear();
  for (const Triangle& t : surface.triangles)
    part.triangles.push_back(
        {static_cast<std::int32_t>(t[0]), static_cast<std::int32_t>(t[1]), static_cast<std::int32_t>(t[2])});
  part.first.clear();
  part.influences.clear();
  for (const Vec3& x : part.positions) {
    const double upper = std::clamp(x.x() - 1.5, 0.0, 1.0);
    part.first.push_back(part.influences.size());
    if (upper < 1) part.influences.push_back({0, 1 - upper});
    if (upper > 0) part.influences.push_back({1, upper});
  }
  part.first.push_back(part.influences.size());
  return tube;
}

// Names of files; the extension decides the form.
struct GeneratedCharacter {
  const char* name;
  scenes::Character (*make)();
};
inline constexpr GeneratedCharacter kGenerated[] = {{"generated_figure.glb", scenes::walking_figure},
                                                    {"generated_figure.gltf", scenes::walking_figure},
                                                    {"generated_tube.gltf", scenes::bending_tube},
                                                    {"generated_large_tube.glb", large_tube}};

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
