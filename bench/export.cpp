#include <CLI/CLI.hpp>
#include <cstdio>

#include "bench/command.h"
#include "bench/progress.h"
#include "scenes/catalog/scene_cache.h"

namespace cscd::bench {

void add_export(CLI::App& app) {
  struct Options {
    std::string scene, output;
    bool force = false;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand(
      "export",
      "Write exactly the frames that a run replays as a point cache.\n\n  cscd export rope rope.h5");
  command->add_option("scene", options->scene, "a scene (cscd list scenes)")->required();
  command->add_option("output", options->output, "the .h5 file to write")->required();
  command->add_flag("--force", options->force, "replace the output if it exists");
  command->callback([options] {
    const scenes::Scene scene = scenes::load_scene(options->scene);
    std::optional<Progress> progress;
    scenes::export_scene(scene, options->output, options->force, [&](std::size_t done, std::size_t total) {
      if (!progress) progress.emplace("generating " + scene.name, total);
      progress->set(done);
    });
    progress.reset();
    std::printf("%s: %zu frames of %zu vertices and %zu triangles\n", options->output.c_str(), scene.frames,
                scene.expected.vertices, scene.expected.triangles);
  });
}

}  // namespace cscd::bench
