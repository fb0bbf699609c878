#include <CLI/App.hpp>
#include <cstdio>

#include "bench/cli/command_line/command.h"
#include "bench/cli/output/json_text.h"
#include "bench/cli/output/output.h"
#include "bench/measure/replay_options.h"
#include "bench/measure/shards/code_version.h"
#include "bench/measure/shards/plan.h"

namespace cscd::bench {
namespace {

struct PlanOptions {
  ReplayRequest request;
  ReplayKind kind = ReplayKind::counts;
  std::size_t cell_intervals = 100;
  std::string output;
  bool force = false;
};

void plan(const PlanOptions& options) {
  require_sound(options.request);
  OutputFile output(options.output, options.force);
  Input input = open_input(options.request.scene, options.request.model);
  say_what_was_read(input, stdout);
  input.threads = options.request.threads;
  const Plan made =
      make_plan(input, resolve(input, options.request, options.kind), options.cell_intervals, code_version());
  output.commit(json_text(to_json(made)));
  std::printf("plan: %s, %zu cells\nmeasure them: cscd run --plan %s --shard 1/1 --into FOLDER\n",
              options.output.c_str(), made.cells.size(), options.output.c_str());
}

}  // namespace

void add_plan(CLI::App& app) {
  auto options = std::make_shared<PlanOptions>();
  CLI::App* command = app.add_subcommand(
      "plan",
      "Divide a long run into cells that can be measured apart, interrupted and resumed.\n\n"
      "  cscd plan --scene rope --strategy base,drvbc --out plan.json\n"
      "  cscd run --plan plan.json --shard 1/2 --into cells      and 2/2 beside it, or on another machine\n"
      "  cscd merge --plan plan.json cells --out rope.json       one record, as `cscd run` writes it\n\n"
      "A cell is a range of intervals. Its id is a digest of the input's frames, the strategies, all\n"
      "parameters, the intervals and the version of the code, and names the file of its result: a result\n"
      "that is there is never measured again. Results of the kind `counts` are the same to the bit on\n"
      "every machine that the program was built for.");
  command
      ->add_option("--kind", options->kind,
                   "what a cell takes: `counts` (verdicts, counters, digests) or `timings` (times, too)")
      ->transform(CLI::CheckedTransformer(
          std::map<std::string, ReplayKind>{{"counts", ReplayKind::counts}, {"timings", ReplayKind::timings}},
          CLI::ignore_case))
      ->default_str("counts");
  command->add_option("--cell-intervals", options->cell_intervals, "intervals of a cell")
      ->check(CLI::Range(1, 1000000000))
      ->capture_default_str();
  command->add_option("--out", options->output, "where the plan goes, - is standard output")->required();
  command->add_flag("--force", options->force, "replace the output if it exists");
  add_replay_options(*command, options->request);
  command->callback([options] { plan(*options); });
}

}  // namespace cscd::bench
