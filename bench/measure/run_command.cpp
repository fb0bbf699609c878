#include <CLI/App.hpp>
#include <algorithm>
#include <cstdio>
#include <deque>
#include <filesystem>
#include <new>
#include <sys/mman.h>

#include "bench/cli/command_line/command.h"
#include "bench/cli/output/json_text.h"
#include "bench/cli/output/output.h"
#include "bench/measure/cell_limits.h"
#include "bench/measure/record/record.h"
#include "bench/measure/record/shortfall.h"
#include "bench/measure/replay/contestant.h"
#include "bench/measure/replay/replay.h"
#include "bench/measure/replay_options.h"
#include "bench/measure/shards/cell_run.h"
#include "bench/measure/shards/code_version.h"
#include "bench/measure/shards/shard.h"
#include "bench/measure/strategies/catalogue.h"
#include "bench/query/answer/ignore.h"
#include "bench/query/input/input.h"
#include "bench/query/options/answer_options.h"
#include "bench/tables/run_times.h"
#include "core/base/error.h"
#include "scenes/base/output_target.h"
#include "scenes/catalog/scene_cache.h"
#include "scenes/sandbox/run_limited.h"

namespace cscd::bench {
namespace {

constexpr char kAllScenes[] = "all";
struct RunOptions {
  ReplayRequest request;
  IgnoreRequest ignored;
  std::string output;
  bool force = false;
  // Instead of a request: cells of a plan.
  std::string plan, shard = "1/1", cell, into;
  CellLimits limits;
};

constexpr std::size_t kListedFailures = 5;  // of a row; the record holds all

unsigned long long count(std::uint64_t number) {
  return number;
}

void print(const VerificationRecord& v, const std::string& timed) {
  std::printf("intervals verified against %s with the elementary test %s, in %.1f s: %zu\n",
              v.reference.c_str(), v.elementary.c_str(), v.seconds, v.intervals.size());
  std::printf("  with contacts: %zu%s\n", v.colliding.size(),
              v.colliding.empty() ? ", so a row could fail by inventing one alone" : "");
  if (!v.unembedded.empty())
    std::printf("  with a start that is not embedded, as the surface crosses itself: %zu\n",
                v.unembedded.size());
  std::size_t width = 0;
  for (const VerifiedStrategy& s : v.strategies) width = std::max(width, s.name.size());
  for (const VerifiedStrategy& s : v.strategies) {
    const std::optional<Shortfall> lacking = shortfall(v, s);
    std::printf("  %-*s  %-17s %-6s  %s\n", static_cast<int>(width), s.name.c_str(), s.guarantee.c_str(),
                s.failures.empty() ? "ok" : "FAILED",
                lacking ? shortfall_text(*lacking).c_str() : "kept all contacts");
    for (std::size_t i = 0; i < std::min(kListedFailures, s.failures.size()); ++i)
      std::printf("    %s\n", s.failures[i].c_str());
    if (s.failures.size() > kListedFailures)
      std::printf("    and %zu more, which the record holds\n", s.failures.size() - kListedFailures);
  }
  for (const auto& own : v.own_tests)
    std::printf(
        "  %s asks its own test: %s contacts missed, %s invented, times off by at most %s of an interval\n",
        own["strategy"].get<std::string>().c_str(), own["misses"].dump().c_str(),
        own["false_alarms"].dump().c_str(), own["largest_time_error"].dump().c_str());
  std::printf(
      "the timed test %s on %llu feature pairs: %llu contacts missed, %llu invented, %llu undecided, "
      "times off by\nat most %.2g of an interval\n",
      timed.c_str(), count(v.accuracy_tests), count(v.accuracy.misses), count(v.accuracy.false_alarms),
      count(v.accuracy.undecided), v.accuracy.largest_time_error);
}

// Names the strategies that would have run if nothing were ignored.
void say_who_cannot_ignore(const Input& input, const ReplayRequest& request) {
  const std::vector<std::string> groups =
      request.strategies.empty() ? std::vector<std::string>{""} : request.strategies;
  for (const std::string& group : groups)
    for (const Strategy* strategy : strategies_in(group))
      if (const auto reason = why_not_ignoring(input, *strategy); reason && allows(input, *strategy))
        std::printf("without %s: %s\n", std::string(strategy->name).c_str(), reason->c_str());
}

// Whether every strategy kept its promise.
bool run_one(const RunOptions& options, const ReplayRequest& request, OutputFile& output) {
  Input input = open_input(request.scene, request.model);
  say_what_was_read(input, stdout);
  input.threads = request.threads;
  ignore(input, options.ignored);
  say_who_cannot_ignore(input, request);
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
    ok = run_one(options, runs[i], outputs[i]) && ok;
    std::printf("record: %s\n", (folder / (runs[i].scene + ".json")).c_str());
  }
  return ok;
}

void require_same_code(const Plan& plan, const std::string& file) {
  if (const nlohmann::ordered_json here = code_version(); here != plan.code)
    throw InputError("plan " + file + ": was made by " + plan.code.dump() + ", and this program is " +
                     here.dump() + "; make the plan anew, or run the program that made it");
}

// Whether the process has met a limit on its memory. Libraries that it calls may not say so: HDF5 takes a
// lack of memory for a damaged file.
bool is_out_of_memory() {
  constexpr std::size_t kProbe = std::size_t{8} << 20;
  void* const probe = mmap(nullptr, kProbe, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (probe == MAP_FAILED) return true;
  munmap(probe, kProbe);
  return false;
}

// The process of one cell tells by its exit status why there is no result.
void run_one_cell(const Plan& plan, const RunOptions& options) {
  const auto cell = std::ranges::find(plan.cells, options.cell, &PlanCell::id);
  if (cell == plan.cells.end())
    throw InputError("--cell " + options.cell + ": is none of plan " + options.plan + "; its cells have ids");
  CellStatus status = CellStatus::done;
  try {
    if (options.limits.memory_mib) scenes::limit_memory(*options.limits.memory_mib << 20);
    if (!run_cell(plan, *cell, options.into)) status = CellStatus::broken_promise;
  } catch (const OutputError& error) {
    std::fprintf(stderr, "cscd: %s\n", error.what());
    status = status_of_refusal(error.reason);
  } catch (const std::bad_alloc&) {
    status = CellStatus::memory_limit;
  } catch (const InputError&) {
    if (!is_out_of_memory()) throw;
    status = CellStatus::memory_limit;
  }
  if (status == CellStatus::memory_limit)
    std::fprintf(stderr, "cscd: out of memory; raise --cell-memory, or use a machine with more\n");
  if (status != CellStatus::done) throw ExitStatus{exit_status(status)};
}

void run_plan(const RunOptions& options) {
  if (options.into.empty()) throw CLI::RequiredError("--into");
  const Plan plan = read_plan(options.plan);
  require_same_code(plan, options.plan);
  std::error_code error;
  std::filesystem::create_directories(options.into, error);
  if (error)
    throw InputError("folder " + options.into + ": cannot be made: " + error.message() +
                     "; choose another with --into");
  if (!options.cell.empty()) return run_one_cell(plan, options);
  const std::vector<CellState> states =
      run_shard(plan, options.plan, parse_shard(options.shard), options.into, options.limits);
  const auto count = [&](CellStatus status) {
    return std::ranges::count(states, status, &CellState::status);
  };
  const auto done = count(CellStatus::done), broken = count(CellStatus::broken_promise);
  if (const auto left = std::ssize(states) - done - broken; left > 0)
    throw InputError("shard " + options.shard + ": " + std::to_string(left) + " of " +
                     std::to_string(states.size()) +
                     " cells have no result, for the reasons above; the same command measures them again");
  std::printf("shard %s: all %zu cells have results\n", options.shard.c_str(), states.size());
  if (broken > 0) throw kVerificationFailed;
}

void run(const RunOptions& options) {
  if (!options.plan.empty()) return run_plan(options);
  if (options.output.empty()) throw CLI::RequiredError("--json");
  require_sound(options.request);  // before anything is opened
  if (options.request.scene == kAllScenes) {
    if (!run_all(options)) throw kVerificationFailed;
    return;
  }
  OutputFile output(options.output, options.force);
  const bool ok = run_one(options, options.request, output);
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
  add_ignore_options(*command, options->ignored);
  command->add_option(
      "--json", options->output,
      "where the record goes, - is standard output; with --scene all, the folder of the records");
  command->add_flag("--force", options->force, "replace the output if it exists");
  // A plan says what is measured, and in which files results go.
  std::vector<CLI::Option*> of_requests;
  for (CLI::Option* option : command->get_options())
    if (option->get_name() != "--help") of_requests.push_back(option);
  CLI::Option* plan = command->add_option("--plan", options->plan, "measure cells of this plan (cscd plan)");
  for (CLI::Option* option : of_requests) plan->excludes(option);
  command->add_option("--shard", options->shard, "I/N, the I-th of N parts of the cells")
      ->capture_default_str();
  command->add_option("--into", options->into, "the folder of the results");
  add_cell_limits(*command, options->limits);
  command->add_option(
      "--cell", options->cell,
      "one cell alone, by its id, in this process; exit status 4 a full disk, 5 a folder that "
      "is\nread-only, 6 out of memory");
  for (CLI::Option* option : command->get_options()) {
    if (option->get_name() == "--help" || std::ranges::find(of_requests, option) != of_requests.end())
      continue;
    option->group("Cells of a plan");
    if (option != plan) option->needs(plan);
  }
  command->callback([options] { run(*options); });
}

}  // namespace cscd::bench
