#include <CLI/App.hpp>
#include <algorithm>
#include <cstdio>
#include <deque>
#include <filesystem>

#include "bench/commands/command.h"
#include "bench/input/input.h"
#include "bench/measure/replay.h"
#include "bench/options/replay_options.h"
#include "bench/output/json_text.h"
#include "bench/output/output.h"
#include "bench/record/record.h"
#include "bench/tables/run_times.h"
#include "core/base/error.h"
#include "scenes/catalog/scene_cache.h"

namespace cscd::bench {
namespace {

constexpr char kAllScenes[] = "all";
struct RunOptions {
  ReplayRequest request;
  std::string output;
  bool force = false;
};

void print(const VerificationRecord& v, const std::string& timed) {
  std::printf("verified on %zu intervals against %s with the elementary test %s, in %.1f s\n",
              v.intervals.size(), v.reference.c_str(), v.elementary.c_str(), v.seconds);
  for (const VerifiedStrategy& s : v.strategies) {
    std::printf("  %-8s %-13s %s, kept %llu of %llu contacts; contact promised on %llu intervals\n",
                s.name.c_str(), s.guarantee.c_str(), s.failures.empty() ? "ok" : "FAILED",
                static_cast<unsigned long long>(s.contacts_found),
                static_cast<unsigned long long>(s.contacts_expected),
                static_cast<unsigned long long>(s.intervals_promised));
    for (const std::string& failure : s.failures) std::printf("    %s\n", failure.c_str());
  }
  for (const auto& own : v.own_tests)
    std::printf("  %s asks its own test: %s contacts missed, %s invented, times off by at most %s\n",
                own["strategy"].get<std::string>().c_str(), own["misses"].dump().c_str(),
                own["false_alarms"].dump().c_str(), own["largest_time_error"].dump().c_str());
  std::printf(
      "  %s on %llu feature pairs: %llu misses, %llu false alarms, %llu undecided, times off by at most "
      "%.2g\n",
      timed.c_str(), static_cast<unsigned long long>(v.accuracy_tests),
      static_cast<unsigned long long>(v.accuracy.misses),
      static_cast<unsigned long long>(v.accuracy.false_alarms),
      static_cast<unsigned long long>(v.accuracy.undecided), v.accuracy.largest_time_error);
}

// Whether every strategy kept its promise.
bool run_one(const ReplayRequest& request, OutputFile& output) {
  Input input = open_input(request.scene, request.model);
  say_what_was_read(input, stdout);
  input.threads = request.threads;
  const Record record = execute(input, resolve(input, request, ReplayKind::timings));
  print(record.verification, request.elementary);
  output.commit(json_text(to_json(record)));
  std::printf("%s", run_times_text(record).c_str());
  return record.verification.ok();
}

// Every scene that there is, each to its own record in the folder named as output.
bool run_all(const RunOptions& options) {
  const std::filesystem::path folder = options.output;
  if (is_standard_output(folder))
    throw InputError("--json " + options.output +
                     ": several records do not go to standard output; name a folder, or one scene");
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error)
    throw InputError("folder " + folder.string() + ": cannot be made: " + error.message() +
                     "; choose another with --json");
  const std::vector<scenes::SceneSummary> all = scenes::list_scenes();
  for (const scenes::SceneSummary& scene : all)
    if (!scene.fault.empty())
      throw InputError("--scene all: " + scene.fault + " (scene " + scene.name +
                       "); mend or remove that file, or name the scenes one by one");
  std::vector<ReplayRequest> runs;
  std::deque<OutputFile> outputs;  // what stands in the way of any is found before the work
  for (const scenes::SceneSummary& scene : all) {
    runs.push_back(options.request);
    runs.back().scene = scene.name;
    outputs.emplace_back(folder / (scene.name + ".json"), options.force);
  }
  bool ok = true;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    std::printf("%s%s\n", i > 0 ? "\n" : "", runs[i].scene.c_str());
    ok = run_one(runs[i], outputs[i]) && ok;
    std::printf("record: %s\n", (folder / (runs[i].scene + ".json")).c_str());
  }
  return ok;
}

void run(const RunOptions& options) {
  require_sound(options.request);  // before anything is opened
  if (options.request.scene == kAllScenes) {
    if (!run_all(options)) throw kVerificationFailed;
    return;
  }
  OutputFile output(options.output, options.force);
  const bool ok = run_one(options.request, output);
  std::printf("record: %s\n", options.output.c_str());
  if (!ok) throw kVerificationFailed;
}

}  // namespace

void add_run(CLI::App& app) {
  auto options = std::make_shared<RunOptions>();
  CLI::App* command = app.add_subcommand(
      "run",
      "Replay a scene with several culling strategies: verify their answers, then time them.\n\n"
      "  cscd run --scene rope --json rope.json\n"
      "  cscd run --scene all --json records         a record of every scene into that folder\n"
      "  cscd run --smoke --json smoke.json          a few intervals, in seconds\n\n"
      "First every strategy answers the verified intervals with the exact elementary test and is judged "
      "against\n"
      "the complete reference under its own guarantee. If one fails, the exit status is 1 and the record "
      "holds\n"
      "the failures and no times. Then the strategies are timed interleaved, interval by interval in a "
      "seeded\n"
      "random order. The record keeps every sample; `cscd tables` makes tables of it.\n\n"
      "Rows that belong to a group (cscd list strategies) run only when they or their group is named: all "
      "pairs of\n"
      "triangles, a thousand million of them on the rope at every interval, and the ablation.");
  add_replay_options(*command, options->request);
  command->add_option(
      "--json", options->output,
      "where the record goes, - is standard output; with --scene all, the folder of the records")
      ->required();
  command->add_flag("--force", options->force, "replace the output if it exists");
  command->callback([options] { run(*options); });
}

}  // namespace cscd::bench
