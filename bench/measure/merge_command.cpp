#include <CLI/App.hpp>
#include <cstdio>

#include "bench/cli/command_line/command.h"
#include "bench/cli/output/json_text.h"
#include "bench/cli/output/output.h"
#include "bench/measure/shards/merge.h"
#include "core/base/error.h"

namespace cscd::bench {
namespace {

struct MergeOptions {
  std::string plan, output;
  std::vector<std::filesystem::path> folders;
  bool force = false;
};

void require_whole(const Plan& plan, const MergeOptions& options) {
  const std::vector<const PlanCell*> missing = missing_cells(plan, options.folders);
  if (missing.empty()) return;
  for (const PlanCell* cell : missing)
    std::printf("missing: cell %s, %s\n", cell->id.c_str(), frames_text(*cell).c_str());
  throw InputError(std::to_string(missing.size()) + " of " + std::to_string(plan.cells.size()) +
                   " cells have no result; measure them with cscd run --plan " + options.plan + " --into " +
                   options.folders.front().string());
}

void merge_into_record(const MergeOptions& options) {
  const Plan plan = read_plan(options.plan);
  OutputFile output(options.output, options.force);
  require_whole(plan, options);
  const Record record = merge(plan, options.folders);
  output.commit(json_text(to_json(record)));
  std::printf("record: %s, of %zu cells\n", options.output.c_str(), plan.cells.size());
  if (!record.verification.ok()) throw kVerificationFailed;
}

}  // namespace

void add_merge(CLI::App& app) {
  auto options = std::make_shared<MergeOptions>();
  CLI::App* command = app.add_subcommand(
      "merge",
      "Join the results of a plan's cells into one record.\n\n"
      "  cscd merge --plan plan.json cells --out rope.json\n\n"
      "The record is the same to the bit, whoever measured the cells and in whatever order. Where cells "
      "have\n"
      "no result, they are listed, and the exit status is 2. Results of different versions of the code are\n"
      "never joined, nor times of different machines. Exit status 1: a strategy broke its promise.");
  command->add_option("folders", options->folders, "the folders of the results")->required();
  command->add_option("--plan", options->plan, "the plan, as `cscd plan` wrote it")->required();
  command->add_option("--out", options->output, "where the record goes, - is standard output")->required();
  command->add_flag("--force", options->force, "replace the output if it exists");
  command->callback([options] { merge_into_record(*options); });
}

}  // namespace cscd::bench
