#pragma once

#include <string>

#include "bench/inputs/input.h"
#include "bench/testing/test_generated.h"

namespace cscd::bench {

// A clip of the generated figure, whose eyes lie in its head at rest; of the closed body alone where a
// strategy needs one.
inline Input figure_for(const Strategy& strategy, const std::string& clip, const Scratch& scratch) {
  ModelOptions options;
  options.import.clip = clip;
  options.import.fps = 12;
  const std::string file = character_file("generated_figure.glb", scratch);
  Input input = open_input(file, options);
  if (allows(input, strategy)) return input;
  options.import.component = "auto";
  return open_input(file, options);
}

}  // namespace cscd::bench
