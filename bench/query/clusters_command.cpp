#include <CLI/App.hpp>
#include <nlohmann/json.hpp>

#include "bench/command_line/add_options.h"
#include "bench/command_line/command.h"
#include "bench/inputs/input.h"
#include "bench/inputs/input_options.h"
#include "bench/output/output.h"
#include "bench/query/view/strategy_observers.h"
#include "bench/strategies/catalogue.h"
#include "core/base/error.h"
#include "core/elementary/catalogue.h"

namespace cscd::bench {
namespace {

struct ClusterOptions {
  std::string input, strategy, output;
  std::size_t frame = 0;
  bool force = false;
  ModelOptions model;
};

// One interval's clusters and the surface at its start, for a picture.
void clusters(const ClusterOptions& options) {
  const Strategy* strategy = options.strategy.empty() ? nullptr : &strategy_named(options.strategy);
  OutputFile output(options.output, options.force);
  Input input = open_input(options.input, options.model);
  say_what_was_read(input, stdout);
  if (strategy == nullptr) strategy = &default_strategy(input, true);
  if (options.frame >= input.clip->interval_count())
    throw InputError("--frame " + std::to_string(options.frame) + ": " + options.input +
                     " has intervals 0 to " + std::to_string(input.clip->interval_count() - 1) +
                     "; choose one of them");

  StrategyObservers observers(input, *strategy, elementary_tests().front());
  if (observers.preparation().atomic_cluster.empty())
    throw InputError("strategy " + std::string(strategy->name) + " has no clusters; choose a radial one");
  const scenes::ClipInterval interval = input.clip->load(options.frame);
  observers.look(interval);
  const RadialView view = observers.view();
  nlohmann::json positions = nlohmann::json::array(), triangles = nlohmann::json::array();
  for (const Vec3& x : interval.motion.start()) positions.push_back({x.x(), x.y(), x.z()});
  for (const Triangle& corner : input.mesh.triangles())
    triangles.push_back(
        {static_cast<int>(corner[0]), static_cast<int>(corner[1]), static_cast<int>(corner[2])});
  const nlohmann::json document = {{"schema", "cscd.clusters/1"},
                                   {"input", options.input},
                                   {"strategy", strategy->name},
                                   {"frame", options.frame},
                                   {"triangle_cluster", observers.preparation().atomic_cluster},
                                   {"mega_cluster", view.cluster},
                                   {"positive", view.positive},
                                   {"positions", std::move(positions)},
                                   {"triangles", std::move(triangles)}};
  output.commit(document.dump() + "\n");
}

}  // namespace

void add_clusters(CLI::App& app) {
  auto options = std::make_shared<ClusterOptions>();
  CLI::App* command = app.add_subcommand("clusters",
                                         "Write the surface at one frame with the cluster of every triangle "
                                         "and whether the observer of that cluster sees its front "
                                         "throughout the interval, for a picture.");
  using C = ClusterOptions;
  static const OptionRow<C> rows[] = {
      required<C>({"input", &C::input, kInputHelp}),
      {.name = "--frame", .member = &C::frame, .help = "where the interval starts", .names_zero = true},
      {"--strategy", &C::strategy, "a radial strategy; default the best that the input allows"}};
  add_options<C>(*command, rows, *options);
  add_output_options(*command, *options, "where it goes; - is standard output", true);
  add_model_options(*command, options->model);
  command->callback([options] { clusters(*options); });
}

}  // namespace cscd::bench
