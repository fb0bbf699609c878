#include <CLI/App.hpp>
#include <algorithm>
#include <cstdio>
#include <deque>
#include <filesystem>

#include "bench/command_line/add_options.h"
#include "bench/command_line/command.h"
#include "bench/harness/contestant.h"
#include "bench/harness/replay.h"
#include "bench/inputs/ignore.h"
#include "bench/inputs/input.h"
#include "bench/inputs/input_options.h"
#include "bench/inputs/thickness.h"
#include "bench/measure/shards/shards.h"
#include "bench/output/json_text.h"
#include "bench/output/output.h"
#include "bench/records/record.h"
#include "bench/records/shortfall.h"
#include "bench/strategies/catalogue.h"
#include "bench/tables/run_times.h"
#include "core/base/error.h"
#include "scenes/base/files_in.h"
#include "scenes/catalog/plain_name.h"
#include "scenes/catalog/scene.h"
#include "scenes/exchange/sequence_files.h"

namespace cscd::bench {
namespace {

constexpr char kAllScenes[] = "all";
struct RunOptions {
  ReplayRequest request;
  IgnoreRequest ignored;
  ThicknessRequest thickness;
  std::string output;
  bool force = false;
  // Where results of shards are kept. Without a folder, the run is not divided.
  std::string shards, worker;
  std::size_t shard_intervals = 100;
};

constexpr std::size_t kListedFailures = 5;  // of a row; the record holds all

unsigned long long count(std::uint64_t number) {
  return number;
}

void print(const VerificationRecord& v, const std::string& timed, bool is_thick) {
  std::printf("intervals verified against %s with the elementary test %s, in %.1f s: %zu\n",
              v.reference.c_str(), v.elementary.c_str(), v.seconds, v.intervals.size());
  std::printf("  with contacts: %zu%s\n", v.colliding.size(),
              v.colliding.empty() ? ", so a row could fail by inventing one alone" : "");
  if (v.truth) {
    std::printf("  held against %s (%llu pairs, %llu contacts): %llu missed, %llu invented%s\n",
                v.truth->file.c_str(), count(v.truth->pairs), count(v.truth->contacts),
                count(v.truth->missed), count(v.truth->invented), v.truth->ok() ? "" : ", FAILED");
    for (const std::string& difference : v.truth->differences) std::printf("    %s\n", difference.c_str());
  }
  if (!v.unembedded.empty())
    std::printf(
        "  with a start that is not %s: %zu\n",
        is_thick ? "clear, as something crosses or is close" : "embedded, as the surface crosses itself",
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

// Names the strategies that would have run if nothing were ignored and nothing but touching counted.
void say_who_is_left_out(const Input& input, const ReplayRequest& request) {
  const std::vector<std::string> groups =
      request.strategies.empty() ? std::vector<std::string>{""} : request.strategies;
  for (const std::string& group : groups)
    for (const Strategy* strategy : strategies_in(group))
      if (allows(input, *strategy)) {
        const std::string distance = why_not_within(input.thickness.asked, *strategy);
        const std::string reason = why_not_ignoring(input, *strategy).value_or(distance);
        if (!reason.empty())
          std::printf("without %s: %s\n", std::string(strategy->name).c_str(), reason.c_str());
      }
}

// Truth from outside is a gate. Whatever would have to be left out of it is refused.
void read_truth(Input& input) {
  if (!is_point_cache(input.name)) return;
  input.truth = outside_truth(input.name, input.mesh);
  if (!input.truth) return;
  if (const std::size_t intervals = input.clip->interval_count(); intervals != 1)
    throw InputError("truth " + input.truth->file + ": is of one step, and " + input.name + " has " +
                     std::to_string(intervals) + "; move the table away, or give a cache of two frames");
  if (input.ignored || input.thickness.left_out || input.thickness.length > 0)
    throw InputError("--ignore, --thickness: " + input.truth->file + " beside " + input.name +
                     " judges everything that touches, and that alone; move the table away, or leave these "
                     "options out");
}

Input open(const RunOptions& options, const ReplayRequest& request) {
  Input input = open_input(request.scene, request.model);
  say_what_was_read(input, stdout);
  input.threads = request.threads;
  ignore(input, options.ignored);
  set_thickness(input, options.thickness, true);
  read_truth(input);
  say_who_is_left_out(input, request);
  return input;
}

Record measured(const RunOptions& options, Input& input, const Replay& replay) {
  if (options.shards.empty()) return execute(input, replay);
  const std::vector<RunShard> shards = divide(input, replay, options.shard_intervals);
  measure_shards(input, shards, {}, options.shards);
  return join(replay, shards, options.shards);
}

// Whether every strategy kept its promise.
bool run_one(const RunOptions& options, const ReplayRequest& request, OutputFile& output) {
  Input input = open(options, request);
  const Record record = measured(options, input, resolve(input, request));
  print(record.verification, request.elementary, record.thickness > 0);
  output.commit(json_text(to_json(record)));
  std::printf("%s", run_times_text(record).c_str());
  return record.verification.ok();
}

// The point caches of a folder. A folder without any may be that of one moving surface, which is one input.
std::vector<std::string> caches_in(const std::filesystem::path& folder) {
  const std::vector<std::filesystem::path> caches = files_in(folder, {".h5"});
  if (caches.empty() && std::ranges::none_of(files_in(folder, {""}), scenes::is_mesh_sequence_file))
    throw InputError(
        "folder " + folder.string() +
        ": holds no point cache (.h5) and no moving surface (.obj .ply .pc2 .mdd); name a folder "
        "that does, or a file");
  return {caches.begin(), caches.end()};
}

// Each input to its own record in the folder named as output.
bool run_each(const RunOptions& options, const std::vector<std::string>& inputs) {
  const std::filesystem::path folder = options.output;
  if (is_standard_output(folder))
    throw InputError("--json " + options.output +
                     ": several records do not go to standard output; name a folder, or one scene");
  make_folder(folder, "--json");
  std::vector<ReplayRequest> runs;
  std::deque<OutputFile> outputs;  // what stands in the way of any is found before the work
  std::vector<std::filesystem::path> records;
  for (const std::string& input : inputs) {
    runs.push_back(options.request);
    runs.back().scene = input;
    records.push_back(folder / (scenes::plain_name(input) + ".json"));
    outputs.emplace_back(records.back(), options.force);
  }
  bool ok = true;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    std::printf("%s%s\n", i > 0 ? "\n" : "", runs[i].scene.c_str());
    name_input(runs[i].scene, [&] { ok = run_one(options, runs[i], outputs[i]) && ok; });
    std::printf("record: %s\n", records[i].c_str());
  }
  return ok;
}

// Measures this worker's shards of one scene. Whether every strategy kept its promise in them.
bool work(const RunOptions& options) {
  const Worker worker = parse_worker(options.worker);
  Input input = open(options, options.request);
  const std::vector<RunShard> shards =
      divide(input, resolve(input, options.request), options.shard_intervals);
  const bool ok = measure_shards(input, shards, worker, options.shards);
  std::printf("worker %s is done; %zu of %zu shards have no result yet\n", options.worker.c_str(),
              missing_results(shards, options.shards), shards.size());
  return ok;
}

void run(const RunOptions& options) {
  const bool is_worker = !options.worker.empty();
  require_sound(options.request);  // before anything is opened
  require_fit(options.thickness, elementary_test_named(options.request.elementary));
  if (!options.shards.empty()) make_folder(options.shards, "--shards");
  const std::string& scene = options.request.scene;
  bool ok = true;
  if (is_worker) {
    name_input(scene, [&] { ok = work(options); });
    if (!ok) end_with(ExitStatus::failed);
    return;
  }
  std::error_code unknown;
  std::vector<std::string> several;
  if (std::filesystem::is_directory(scene, unknown))
    several = caches_in(scene);
  else if (scene == kAllScenes)
    several = scenes::all_scene_names();
  if (!several.empty()) {
    if (!run_each(options, several)) end_with(ExitStatus::failed);
    return;
  }
  OutputFile output(options.output, options.force);
  name_input(scene, [&] { ok = run_one(options, options.request, output); });
  std::printf("record: %s\n", options.output.c_str());
  if (!ok) end_with(ExitStatus::failed);
}

// The options that say what is measured. `request` must live as long as the command.
void add_replay_options(CLI::App& command, ReplayRequest& request) {
  command
      .add_option_function<std::vector<std::string>>(
          "--scene,--input",
          [&request](const std::vector<std::string>& inputs) {
            if (inputs.size() > 1)
              throw InputError("--scene and --input are two names of one option, and both " + inputs[0] +
                               " and " + inputs[1] +
                               " are given; give one, or a folder of point caches, or all");
            request.scene = inputs[0];
          },
          kInputHelp)
      ->allow_extra_args(false)
      ->option_text("TEXT=" + request.scene);
  add_options(command, replay_options(), request);
  add_model_options(command, request.model);
}

}  // namespace

void add_run(CLI::App& app) {
  auto options = std::make_shared<RunOptions>();
  CLI::App* command = app.add_subcommand(
      "run",
      "Replay a scene with several culling strategies: verify their answers, then time them.\n\n"
      "  cscd run --scene rope --json rope.json\n"
      "  cscd run --scene all --json records         a record of every scene into that folder\n"
      "  cscd run --input FOLDER --json records      the same of every point cache (.h5) in FOLDER\n"
      "  cscd run --smoke --json smoke.json          a few intervals, in seconds\n"
      "  cscd run --shards shards --json rope.json     goes on where the same command was interrupted\n\n"
      "First every strategy answers the verified intervals with the exact elementary test and is judged\n"
      "against the complete reference under its own guarantee. If one fails, the exit status is 1 and the\n"
      "record holds the failures and no times. Then the strategies are timed interleaved, interval by\n"
      "interval in a seeded random order. The record keeps every sample; `cscd tables` makes tables of "
      "it.\n\n"
      "Rows that belong to a group (cscd list strategies) run only when they or their group is named: all\n"
      "pairs of triangles, a thousand million of them on the rope at every interval, and the ablation.");
  add_replay_options(*command, options->request);
  add_options(*command, ignore_options(), options->ignored);
  add_options(*command, thickness_options(), options->thickness);
  using R = RunOptions;
  static const OptionRow<R> long_run[] = {
      {"--shards", &R::shards,
       "divide the run into shards, and keep the result of each in this folder: what is\n"
       "there is not measured again"},
      {"--shard-intervals", &R::shard_intervals, "intervals of a shard", {{1, 1'000'000'000}}},
      {"--worker", &R::worker,
       "I/N: measure every N-th shard from the I-th on, and write no record; the same command\n"
       "without --worker measures what is missing and writes it"}};
  add_output_options(*command, *options,
                     "where the record goes, - is standard output; with --scene all or a folder, the folder "
                     "of the records",
                     true);
  CLI::Option* json = command->get_option("--json")->type_name("FILE");
  add_options<R>(*command, long_run, *options, "A long run");
  command->get_option("--shard-intervals")->needs("--shards");
  command->get_option("--worker")->needs("--shards")->excludes(json)->each([json](const std::string&) {
    json->required(false);
  });
  command->callback([options] { run(*options); });
}

}  // namespace cscd::bench
