#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bench/import.h"
#include "core/detect/strategy.h"
#include "core/mesh/rig.h"
#include "core/mesh/triangle_mesh.h"
#include "scenes/clip/clip.h"

namespace cscd::bench {

// What a command works on: a scene by its name, a point cache or a model file by its path.
struct Input {
  std::string name;
  std::unique_ptr<scenes::ClipSource> clip;
  TriangleMesh mesh;
  std::vector<Vec3> reference;  // positions of frame 0
  std::optional<Rig> rig;
  std::optional<scenes::ImportReport> import = std::nullopt;  // of a model file
  int threads = 1;                                            // for whatever can use them

  Setup setup(const ElementaryTest& elementary) const {
    return {mesh, reference, rig ? &*rig : nullptr, elementary, threads};
  }
};

// Throws InputError. Generates a scene whose cache is missing; imports a model file and says on standard
// output what was made of it. Options are for model files only.
Input open_input(const std::string& name_or_path, const ModelOptions& options = {});

// Is it the path of a file that has to be imported, rather than a point cache or the name of a scene?
bool is_model_file(const std::string& name_or_path);
bool is_point_cache(const std::filesystem::path& path);

// Half-open range of intervals.
struct IntervalRange {
  std::size_t first, last;
};
// "A:B" stands for the intervals between frames A and B; either may be left out. Throws InputError.
IntervalRange parse_frames(const std::string& text, std::size_t frame_count);

// Whether the input has what a strategy needs.
bool allows(const Input& input, const Strategy& strategy);

// The last first_contact row without a group that the input allows, or else the complete reference.
const Strategy& default_strategy(const Input& input);

}  // namespace cscd::bench
