#include <CLI/App.hpp>
#include <cstdio>

#include "bench/commands/command.h"
#include "bench/commands/export_glb.h"
#include "bench/commands/model_options.h"
#include "bench/input/input.h"
#include "bench/output/output_format.h"
#include "core/base/error.h"
#include "core/base/output_target.h"
#include "scenes/clip/point_cache.h"

namespace cscd::bench {
namespace {

constexpr std::string_view kFormats[] = {".h5", ".hdf5", ".glb"};

struct ExportOptions {
  std::string input, output;
  bool force = false;
  ModelOptions model;
};

void export_frames(const ExportOptions& options) {
  // An output that cannot be written is refused before the work, not after it.
  const std::string format = require_format(options.output, kFormats);
  const OutputTarget target = find_output_target(options.output, options.force);
  if (target.is_stream)
    throw InputError("output " + options.output +
                     ": is a device or a pipe, and this format needs an ordinary file; choose one");
  if (format == ".glb") {
    export_glb(options.input, options.model, options.output, options.force);
    return;
  }
  { const UnfinishedFile can_be_made(target.path, options.force); }
  const Input input = open_input(options.input, options.model);
  say_what_was_read(input, stdout);
  scenes::PointCacheWriter writer(options.output, input.clip->header(), options.force);
  scenes::copy_frames(*input.clip, writer);
  writer.finish();
  std::printf("%s: %zu frames of %zu vertices and %zu triangles\n", options.output.c_str(),
              input.clip->frame_count(), input.mesh.vertex_count(), input.mesh.triangle_count());
}

}  // namespace

void add_export(CLI::App& app) {
  auto options = std::make_shared<ExportOptions>();
  CLI::App* command = app.add_subcommand("export",
                                         "Write exactly the frames that a run replays as a point cache,\n"
                                         "or a linearly skinned scene as an animated model.\n\n"
                                         "  cscd export rope rope.h5\n"
                                         "  cscd export rope rope.glb\n"
                                         "  cscd export character.glb walk.h5 --clip walk --fps 60");
  command->add_option("input", options->input, kInputHelp)->required();
  command->add_option("output", options->output, "the .h5 or .glb file to write")->required();
  command->add_flag("--force", options->force, "replace the output if it exists");
  add_model_options(*command, options->model);
  command->callback([options] { export_frames(*options); });
}

}  // namespace cscd::bench
