#include "core/detect/nearness.h"

#include <CLI/App.hpp>
#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "bench/commands/command.h"
#include "bench/input/input.h"
#include "bench/measure/interval_choice.h"
#include "bench/options/model_options.h"
#include "bench/output/json_text.h"
#include "bench/output/output.h"
#include "bench/output/progress.h"
#include "bench/statistics/statistics.h"
#include "core/detect/start/embedding.h"

namespace cscd::bench {
namespace {

using nlohmann::ordered_json;

struct NearnessOptions {
  std::string input, frames, output;
  std::size_t every = 1;
  bool force = false;
  ModelOptions model;
};

std::string length(double mean_edges) {
  if (mean_edges >= kFarthest) return "at least " + std::to_string(static_cast<int>(kFarthest));
  char text[32];
  std::snprintf(text, sizeof text, "%.2f", mean_edges);
  return text;
}

void nearness(const NearnessOptions& options) {
  std::optional<OutputFile> output;
  if (!options.output.empty()) output.emplace(options.output, options.force);
  Input input = open_input(options.input, options.model);
  say_what_was_read(input, stdout);
  const IntervalRange range = parse_frames(options.frames, input);
  const std::vector<std::size_t> chosen = every_kth(range, options.every);

  EmbeddingTest embedding(input.mesh, input.reference);
  Nearness measure(input.mesh, input.reference);
  Progress progress("nearness " + options.input, chosen.size());
  const auto at_rest = measure.closest(input.reference);
  ordered_json intervals = ordered_json::array();
  std::vector<double> distances;
  std::size_t near = 0, not_embedded = 0;
  for (const std::size_t i : chosen) {
    const std::span<const Vec3> start = input.clip->load_frame(i).positions;
    const bool embedded = embedding.embedded(start);
    const auto closest = measure.closest(start);
    ordered_json row = {{"index", i}, {"starts_embedded", embedded}, {"distance", nullptr}};
    if (closest) {
      row["distance"] = closest->distance;
      row["triangles"] = {+closest->a, +closest->b};
    }
    intervals.push_back(std::move(row));
    distances.push_back(closest ? closest->distance : kFarthest);
    near += distances.back() < kNear;
    not_embedded += !embedded;
    progress.advance();
  }
  const double share = static_cast<double>(near) / static_cast<double>(chosen.size());
  if (output)
    output->commit(json_text({{"schema", "cscd.nearness/1"},
                              {"input", options.input},
                              {"mean_edge", measure.mean_edge()},
                              {"apart_on_surface", kApartOnSurface},
                              {"near", kNear},
                              {"farthest", kFarthest},
                              {"at_rest", at_rest ? ordered_json(at_rest->distance) : nullptr},
                              {"near_share", share},
                              {"not_embedded", not_embedded},
                              {"intervals", std::move(intervals)}}));
  const auto nearest = std::min_element(distances.begin(), distances.end());
  std::printf(
      "%s: %zu of %zu intervals (%.0f %%) start nearer than %g mean edge lengths; least %s (interval %zu), "
      "median "
      "%s; at rest %s; %zu starts are not embedded\n",
      options.input.c_str(), near, chosen.size(), 100 * share, kNear, length(*nearest).c_str(),
      chosen[static_cast<std::size_t>(nearest - distances.begin())], length(median(distances)).c_str(),
      length(at_rest ? at_rest->distance : kFarthest).c_str(), not_embedded);
}

}  // namespace

void add_nearness(CLI::App& app) {
  auto options = std::make_shared<NearnessOptions>();
  CLI::App* command =
      app.add_subcommand("nearness",
                         "Measure how near a clip comes to touching itself: for each interval the closest "
                         "distance, at its start, of\n"
                         "two triangles that are apart on the surface, in mean edge lengths of frame 0.\n\n"
                         "  cscd nearness rope\n"
                         "  cscd nearness character.h5 --every 10 --json near.json\n\n"
                         "Apart on the surface: every path along edges of frame 0 between them is longer "
                         "than 8 mean edge lengths.\n"
                         "Distances of 4 mean edge lengths and more are not told apart (null). Whether "
                         "starts are embedded is decided\n"
                         "exactly.");
  command->add_option("input", options->input, kInputHelp)->required();
  command->add_option("--frames", options->frames, "A:B, the intervals between frames A and B; default all");
  command->add_option("--every", options->every, "measure each K-th interval, from the first")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  command->add_option("--json", options->output,
                      "all distances, for a machine to read; - is standard output");
  command->add_flag("--force", options->force, "replace the output if it exists");
  add_model_options(*command, options->model);
  command->callback([options] { nearness(*options); });
}

}  // namespace cscd::bench
