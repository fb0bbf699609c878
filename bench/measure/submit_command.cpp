#include <CLI/App.hpp>
#include <algorithm>
#include <cstdio>

#include "bench/cli/command_line/command.h"
#include "bench/cli/output/output.h"
#include "bench/measure/cell_limits.h"
#include "bench/measure/shards/submit.h"
#include "core/base/error.h"

namespace cscd::bench {
namespace {

struct SubmitOptions {
  Submission submission;
  std::string executor = "local", script;
  bool force = false;
};

void submit(const SubmitOptions& options) {
  const Plan plan = read_plan(options.submission.plan);
  Submission submission = options.submission;
  submission.workers = std::min(submission.workers, plan.cells.size());
  submission.kind = plan.replay.kind;
  submission.threads = plan.replay.request.threads;
  if (options.executor == "local") {
    if (!options.script.empty()) throw InputError("--script: is of --executor slurm; leave it out");
    if (submission.kind == ReplayKind::timings && submission.workers > 1)
      throw InputError(
          "--workers: workers that take times on one machine would slow each other down; leave it out");
    if (const int worst = work_here(submission); worst != 0) throw ExitStatus{worst};
    return;
  }
  const std::string script = slurm_script(submission);
  if (options.script.empty()) return send_to_slurm(script);
  OutputFile(options.script, options.force, ".sbatch").commit(script);
}

}  // namespace

void add_submit(CLI::App& app) {
  auto options = std::make_shared<SubmitOptions>();
  Submission& submission = options->submission;
  CLI::App* command = app.add_subcommand(
      "submit",
      "Start workers for all cells of a plan, here or on a cluster.\n\n"
      "  cscd submit --plan plan.json --into cells --workers 8\n"
      "  cscd submit --plan plan.json --into cells --workers 200 --executor slurm\n"
      "  cscd submit --plan plan.json --into cells --workers 200 --executor slurm --script job.sbatch\n\n"
      "`local` runs the workers as processes of this machine and waits for them; the exit status is the\n"
      "largest of theirs. `slurm` hands an array job to sbatch, or writes its script. SBATCH_ variables\n"
      "choose partition, time and memory. Workers that count share nodes; each that takes times has a node\n"
      "to itself, and here there is one such worker. A worker that would have no cell is not started.\n"
      "Given again, the command measures what has no result yet.");
  command->add_option("--plan", submission.plan, "the plan, as `cscd plan` wrote it")->required();
  command->add_option("--into", submission.folder, "the folder of the results, which all workers see")
      ->required();
  command->add_option("--workers", submission.workers, "how many workers share the cells")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  command->add_option("--executor", options->executor, "local or slurm")
      ->check(CLI::IsMember({"local", "slurm"}))
      ->capture_default_str();
  command->add_option(
      "--script", options->script,
      "slurm: write the script to this .sbatch file instead of sending it; - is standard output");
  command->add_flag("--force", options->force, "replace the script if it exists");
  add_cell_limits(*command, submission.limits);
  command->callback([options] { submit(*options); });
}

}  // namespace cscd::bench
