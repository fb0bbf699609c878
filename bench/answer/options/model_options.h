#pragma once

#include <CLI/App.hpp>

#include "bench/inputs/import.h"

namespace cscd::bench {

inline constexpr char kInputHelp[] =
    "a scene (cscd list), a .h5 point cache, a model file (.glb .gltf .fbx .dae .x),\nor a moving surface "
    "(.pc2 or .mdd beside its .obj, or one file or the folder of an .obj or .ply sequence)";

// The options of every command that takes a model file. `options` must live as long as the command.
void add_model_options(CLI::App& command, ModelOptions& options);

// --threads, of every command that answers intervals.
void add_threads_option(CLI::App& command, int& threads);

}  // namespace cscd::bench
