#pragma once

#include "bench/command_line/option_rows.h"
#include "bench/inputs/input.h"

namespace CLI {
class App;
}

// The options that say which input, and how it is taken. Owners must live as long as the command that the
// options are added to.
namespace cscd::bench {

inline constexpr char kInputHelp[] =
    "a scene (cscd list), a .h5 point cache, a model file (.glb .gltf .fbx .dae .x),\nor a moving surface "
    "(.pc2 or .mdd beside its .obj, or one file or the folder of an .obj or .ply sequence)";

// How a model file is imported.
std::span<const OptionRow<scenes::ImportOptions>> import_options();
// --ignore and --ignore-neighbours.
std::span<const OptionRow<IgnoreRequest>> ignore_options();
// --thickness, and then --exclude-rings and --exclude-near-rest.
std::span<const OptionRow<ThicknessRequest>> thickness_options();
// --threads, of every command that answers intervals.
template <class Owner>
OptionRow<Owner> threads_option() {
  return {"--threads",
          &Owner::threads,
          "threads that answer an interval together, where the strategy can share its work\n"
          "(drvbc_fast, drvbc_fast_all, drvbc_fast_complete); the others run on one. Answers are\n"
          "the same on any number",
          {{1, 1024}}};
}

// The options of every command that takes a model file: those of the import, and its limits.
void add_model_options(CLI::App& command, ModelOptions& options);

}  // namespace cscd::bench
