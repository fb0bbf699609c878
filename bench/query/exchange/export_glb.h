#pragma once

#include <filesystem>
#include <string>

#include "bench/query/input/import.h"

namespace cscd::bench {

// Writes a scene as a skinned, animated model in glTF's binary form and says on standard output what it
// holds. Throws InputError for an input that is not the name of a scene, for options of model files, for a
// scene that is not skinned linearly, and for an output that cannot be written.
void export_glb(const std::string& input, const ModelOptions& options, const std::filesystem::path& output,
                bool force);

}  // namespace cscd::bench
