#include "bench/query/exchange/export_glb.h"

#include <cstdio>
#include <optional>

#include "bench/cli/output/output.h"
#include "bench/cli/output/progress.h"
#include "bench/query/input/input.h"
#include "core/base/error.h"
#include "scenes/export/glb.h"
#include "scenes/export/skinned_scene.h"

namespace cscd::bench {

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
  std::optional<Progress> progress;
  const scenes::Character character = scenes::skinned_scene(scene, [&](std::size_t done, std::size_t total) {
    if (!progress) progress.emplace("generating " + input, total);
    progress->set(done);
  });
  progress.reset();
  file.commit(scenes::to_glb(character));
  std::printf("%s: %zu frames at %g a second of %zu bones, %zu vertices and %zu triangles\n",
              output.string().c_str(), scene.frames, scenes::kExportedFps, character.parts[0].joints.size(),
              character.parts[0].positions.size(), character.parts[0].triangles.size());
}

}  // namespace cscd::bench
