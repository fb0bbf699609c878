#include <CLI/App.hpp>
#include <cstdio>

#include "bench/answer/answer_request.h"
#include "bench/answer/clip_answerer.h"
#include "bench/command_line/add_options.h"
#include "bench/command_line/command.h"
#include "bench/inputs/input.h"
#include "bench/output/output.h"
#include "bench/output/progress.h"
#include "bench/query/export_files.h"
#include "core/base/error.h"
#include "scenes/base/output_target.h"
#include "scenes/export/glb.h"
#include "scenes/export/skinned_scene.h"

namespace cscd::bench {
namespace {

constexpr std::string_view kFormats[] = {".h5",  ".hdf5", ".glb", ".pc2", ".mdd",
                                         ".obj", ".ply",  ".pvd", ".usda"};

struct ExportOptions : AnswerRequest {
  std::string output;
  bool force = false, bake = false, events = false;
  std::string answer_option;  // one that was given, and that nothing but an answer goes by; empty for none
};

// Writes a scene as a skinned, animated model in glTF's binary form and says on standard output what it
// holds. Refuses an input that is not the name of a scene, options of model files, and a scene that is not
// skinned linearly.
void export_glb(const std::string& input, const ModelOptions& options, const std::filesystem::path& output,
                bool force) {
  if (is_model_file(input))
    throw InputError(
        "input " + input +
        ": is a file; only a scene, by its name in `cscd list`, can become a .glb file with bones; "
        "export this with --bake, or as .h5");
  if (is_point_cache(input))
    throw InputError(
        "input " + input +
        ": is a point cache, which has no weights that bind vertices to bones, so it cannot become "
        "a .glb file with bones; export it with --bake, or as .h5, or name a scene");
  if (options != ModelOptions{})
    throw InputError(
        "input " + input +
        ": is a scene, whose frames are written as they are; leave out the options of model files "
        "(--clip, --fps, ...)");
  const scenes::Scene scene = scenes::load_scene(input);
  OutputFile file(output, force, ".glb");
  const scenes::Character character = scenes::skinned_scene(scene, progress_of("generating " + input));
  file.commit(scenes::to_glb(character));
  std::printf("%s: %zu frames at %g a second of %zu bones, %zu vertices and %zu triangles\n",
              output.string().c_str(), scene.frames, scenes::kExportedFps, character.parts[0].joints.size(),
              character.parts[0].positions.size(), character.parts[0].triangles.size());
}

void export_input(const ExportOptions& options) {
  // An output that cannot be written is refused before the work, not after it.
  const std::string format = require_format(options.output, kFormats);
  if (options.bake && format != ".glb")
    throw InputError("--bake: is for .glb files; " + format +
                     " holds positions in any case, so leave it out");
  const bool has_answers = options.events || format == ".pvd" || format == ".usda";
  if (options.events && format != ".ply")
    throw InputError("--events: is for .ply files; " +
                     std::string(format == ".pvd" || format == ".usda"
                                     ? format + " holds depths and curves in any case, so leave it out"
                                     : "write .ply, or .pvd or .usda, which hold depths and curves anyway"));
  if (!has_answers && !options.answer_option.empty())
    throw InputError(options.answer_option + ": is about contacts, which " + format +
                     " does not hold; leave it out, or write .pvd, .usda, or .ply with --events");
  const bool sequence = format == ".obj" || format == ".ply";  // whose files have other names
  const std::filesystem::path target = file_target(options.output, options.force || sequence);
  if (format == ".glb" && !options.bake) {
    if (!options.frames.empty())
      throw InputError("--frames " + options.frames +
                       ": a scene with its bones is written whole; add --bake");
    export_glb(options.input, options.model, options.output, options.force);
    return;
  }
  require_sound(options);
  if (!sequence) const UnfinishedFile can_be_made(target, options.force);
  Input input = open_input(options.input, options.model);
  say_what_was_read(input, stdout);
  if (input.clip->header().predicted && format != ".h5" && format != ".hdf5")
    std::fprintf(
        stderr,
        "note: intervals of %s end at a simulator's predictions, which .h5 alone keeps: what touches "
        "on the way there need not touch from frame to frame\n",
        options.input.c_str());
  name_input(options.input, [&] {
    if (!has_answers)
      return export_frames(input, parse_frames(options.frames, input), options.output, format, options.force);
    ClipAnswerer asked(options, std::move(input));
    export_answers(asked, options.output, format, options.force);
  });
}

}  // namespace

void add_export(CLI::App& app) {
  auto options = std::make_shared<ExportOptions>();
  CLI::App* command = app.add_subcommand(
      "export",
      "Write the frames that a run replays for another program; the extension names the format.\n\n"
      "  cscd export rope rope.h5            a point cache, exactly\n"
      "  cscd export rope rope.glb           a linearly skinned scene with its bones; --bake: any input, "
      "without\n"
      "  cscd export walk.fbx walk.pc2       a mesh cache for Blender or Maya (.mdd too) beside walk.obj\n"
      "  cscd export rope frames/rope.ply    a file a frame (.obj too), exactly: frames/rope.0000.ply ...\n"
      "  cscd export hand hand.ply --events   the same, coloured by what lies inside what, with its curves\n"
      "  cscd export rope rope.pvd           for ParaView, with clusters, orientation and contacts\n"
      "  cscd export rope rope.usda          points over time, coloured by what touches, with contacts\n"
      "  cscd export character.glb walk.h5 --clip walk --fps 60");
  add_answer_options(*command, *options);
  using E = ExportOptions;
  static const OptionRow<E> rows[] = {
      required<E>({"output", &E::output, "the file to write; its extension names the format"}),
      {"--bake", &E::bake, "a .glb of positions alone, as morph targets, from any input"},
      {"--events", &E::events,
       "a .ply with how deep each vertex lies in another piece, as quality and colour, and "
       "NAME.curves.0000.obj with the curves in which the surface crosses itself"},
      {"--force", &E::force, "replace the output if it exists"}};
  add_options<E>(*command, rows, *options);
  command->callback([options, command] {
    options->answer_option = given_answer_option(*command);
    export_input(*options);
  });
}

}  // namespace cscd::bench
