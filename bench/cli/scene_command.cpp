#include <CLI/App.hpp>
#include <cstdio>

#include "bench/command_line/command.h"
#include "bench/output/progress.h"
#include "scenes/catalog/scene_cache.h"

namespace cscd::bench {
namespace {

std::string file_of(const std::string& name) {
  if (scenes::is_scene_file(name)) return name;
  const scenes::Scene scene = scenes::load_scene(name);
  return (scenes::scenes_folder() / (scene.name + ".json")).string();
}

void accept(const std::string& name) {
  const std::string file = file_of(name);
  const scenes::Expected before = scenes::load_scene(file).expected;
  const scenes::Expected found = scenes::accept_scene(file, progress_of("generating " + name));
  std::printf("%s: %zu vertices, %zu triangles, %zu bones, digest %s%s\n", file.c_str(), *found.vertices,
              *found.triangles, *found.bones, found.digest->c_str(),
              before.digest == found.digest ? ", as before"
              : before.digest               ? (", which was " + *before.digest).c_str()
                                            : "");
}

}  // namespace

void add_scene(CLI::App& app) {
  CLI::App* command = app.add_subcommand("scene", "Work on scene files.");
  command->require_subcommand(1);
  auto file = std::make_shared<std::string>();
  CLI::App* accepting = command->add_subcommand(
      "accept",
      "Write into a scene file what came of it: its counts, and the digest of its frames.\n\n"
      "  cscd scene accept my/scene.json\n\n"
      "Look at the frames first (cscd export). From then on other frames than these are refused. The rest\n"
      "of the file stays as it is.");
  accepting->add_option("file", *file, "a scene file, or the name of a scene")->required();
  accepting->callback([file] { accept(*file); });
}

}  // namespace cscd::bench
