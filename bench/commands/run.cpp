#include <CLI/App.hpp>
#include <algorithm>
#include <cstdio>
#include <deque>
#include <filesystem>

#include "bench/commands/command.h"
#include "bench/commands/model_options.h"
#include "bench/input/input.h"
#include "bench/measure/contestant.h"
#include "bench/measure/footprint.h"
#include "bench/measure/interval_choice.h"
#include "bench/measure/lead.h"
#include "bench/measure/timing.h"
#include "bench/measure/verification.h"
#include "bench/output/json_text.h"
#include "bench/output/output.h"
#include "bench/record/environment.h"
#include "bench/record/record.h"
#include "bench/rows/catalogue.h"
#include "bench/tables/run_times.h"
#include "core/base/error.h"
#include "core/base/pipeline.h"
#include "scenes/catalog/plain_name.h"
#include "scenes/catalog/scene_cache.h"
#include "scenes/clip/digest.h"

namespace cscd::bench {
namespace {

constexpr char kAllScenes[] = "all";
constexpr char kReferee[] = "exact";         // judges culling, whatever test is timed
constexpr char kPublishedTest[] = "newton";  // the paper's

struct RunOptions {
  std::string scene = "rope", elementary = kPublishedTest, pipeline = "today", frames, output;
  std::vector<std::string> strategies;
  std::size_t repetitions = 5, count_every = 1, time_every = 1, time_contacts = 3, verify_every = 1;
  std::uint64_t seed = 2014;
  int threads = 1;
  bool smoke = false, force = false;
  ModelOptions model;
};

// Enough to see that everything works, in seconds; too little to conclude anything from its times.
constexpr std::size_t kSmokeIntervals = 8, kSmokeRepetitions = 2, kSmokeEvery = 4;

// Returns the command line with every default spelt out, and without the place of the result.
std::vector<std::string> command_line(const RunOptions& options, std::span<const Contestant> contestants,
                                      const IntervalRange& range, bool is_model) {
  std::string names;
  for (const Contestant& c : contestants) names += (names.empty() ? "" : ",") + std::string(c.strategy->name);
  std::vector<std::string> words = {"cscd",
                                    "run",
                                    "--scene",
                                    options.scene,
                                    "--strategy",
                                    names,
                                    "--elementary",
                                    options.elementary,
                                    "--pipeline",
                                    options.pipeline,
                                    "--frames",
                                    std::to_string(range.first) + ":" + std::to_string(range.last),
                                    "--repetitions",
                                    std::to_string(options.repetitions),
                                    "--count-every",
                                    std::to_string(options.count_every),
                                    "--time-every",
                                    std::to_string(options.time_every),
                                    "--time-contacts",
                                    std::to_string(options.time_contacts),
                                    "--verify-every",
                                    std::to_string(options.verify_every),
                                    "--seed",
                                    std::to_string(options.seed),
                                    "--threads",
                                    std::to_string(options.threads)};
  if (is_model) {
    const std::vector<std::string> model = to_arguments(options.model.import);
    words.insert(words.end(), model.begin(), model.end());
  }
  return words;
}

SceneRecord describe(Input& input) {
  SceneRecord record;
  const bool is_scene_file = scenes::is_scene_file(input.name);
  const bool is_file = !is_scene_file && (input.import || std::filesystem::path(input.name).has_extension());
  record.name = input.name;
  if (is_file || is_scene_file) {
    record.name = scenes::plain_name(input.name);
    record.path = input.name;
  }
  if (!is_file) {
    const scenes::Scene scene = scenes::load_scene(input.name);
    record.story = scene.story;
    record.effects = scenes::effect_costs(scene);
  }
  scenes::DigestSink digest;
  scenes::copy_frames(*input.clip, digest);
  record.digest = digest.text();
  record.vertices = input.mesh.vertex_count();
  record.triangles = input.mesh.triangle_count();
  record.bones = input.clip->header().bone_parent.size();
  record.frames = input.clip->frame_count();
  return record;
}

StrategyRecord describe(const Contestant& contestant) {
  StrategyRecord record;
  record.name = contestant.strategy->name;
  record.source = contestant.strategy->source;
  record.guarantee = to_string(contestant.strategy->guarantee);
  record.threads = contestant.threads;
  if (contestant.strategy->follows) record.lead = kLead;
  record.preparation = contestant.preparation;
  return record;
}

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

// Every K-th interval of the range, and intervals with contacts beside them, by the fastest complete
// strategy.
std::vector<std::size_t> intervals_to_time(Input& input, const IntervalRange& range,
                                           const RunOptions& options) {
  const std::vector<std::size_t> regular = every_kth(range, options.time_every);
  if (options.time_contacts == 0) return regular;
  const Prepared fastest = complete_stand_in().make(input.setup(elementary_test_named("filtered_exact")));
  return with_contacts(regular, intervals_with_contacts(input, *fastest.detector, range),
                       options.time_contacts);
}

// Judges, counts and times the contestants, and keeps what came of it in the record's strategies. Times are
// missing where a strategy failed.
VerificationRecord verified_and_timed(Input& input, std::span<Contestant> contestants,
                                      const ElementaryTest& exact, const ElementaryTest& timed,
                                      std::span<const std::size_t> to_verify, const RunOptions& options,
                                      Record& record) {
  Verifier verifier(input, contestants, exact, timed);
  verifier.judge(to_verify);
  if (!verifier.record().ok()) return verifier.record();
  const WarmUp counted = warm_up(input, contestants, record.counted_intervals, verifier, record.strategies);
  verifier.judge(counted.disagreeing);
  std::optional<Unrepeatable> void_times = counted.unrepeatable;
  if (!void_times && verifier.record().ok()) {
    const TimingPlan plan{record.timed_intervals, options.repetitions, options.seed};
    void_times = time_contestants(input, contestants, plan, verifier, counted, record.strategies);
    for (StrategyRecord& strategy : record.strategies)
      strategy.footprint = measure_footprint(input, {&strategy_named(strategy.name), false, record.pipeline},
                                             timed, record.timed_intervals);
  }
  VerificationRecord verified = verifier.record();
  verified.disagreeing = counted.disagreeing;
  verified.excused = counted.excused;
  if (void_times) verified.strategies[void_times->contestant].failures.push_back(void_times->failure);
  return verified;
}

// Whether every strategy kept its promise.
bool run_one(RunOptions options, OutputFile& output) {
  const ElementaryTest& timed = elementary_test_named(options.elementary);
  const ElementaryTest& exact = elementary_test_named(kReferee);
  Input input = open_input(options.scene, options.model);
  say_what_was_read(input, stdout);
  input.threads = options.threads;
  IntervalRange range = parse_frames(options.frames, input.clip->frame_count());
  if (options.smoke) {
    if (range.last - range.first > kSmokeIntervals)  // those in the middle, where more happens
      range.first += (range.last - range.first - kSmokeIntervals) / 2;
    range.last = std::min(range.last, range.first + kSmokeIntervals);
    options.repetitions = kSmokeRepetitions;
    options.verify_every = options.time_every = kSmokeEvery;
    options.time_contacts = std::min<std::size_t>(options.time_contacts, 1);
  }
  const std::vector<const Strategy*> strategies =
      chosen_strategies(input, options.strategies, pipeline_named(options.pipeline));
  if (strategies.empty())
    throw InputError("--strategy: " + options.scene +
                     " allows none of these; name others (cscd list strategies)");

  Record record;
  record.environment = environment();
  record.scene = describe(input);
  record.seed = options.seed;
  record.pipeline = pipeline_named(options.pipeline);
  record.elementary = timed.name;
  record.intervals = range.last - range.first;
  record.timed_intervals = intervals_to_time(input, range, options);
  // Whatever is timed is verified.
  const std::vector<std::size_t> to_verify =
      united(std::vector{every_kth(range, options.verify_every), record.timed_intervals});
  record.counted_intervals = united(std::vector{every_kth(range, options.count_every), to_verify});
  std::vector<Contestant> contestants = make_contestants(input, strategies, exact, timed, record.pipeline);
  record.command = command_line(options, contestants, range, input.import.has_value());
  for (const Contestant& contestant : contestants) record.strategies.push_back(describe(contestant));

  record.verification = verified_and_timed(input, contestants, exact, timed, to_verify, options, record);
  const bool ok = record.verification.ok();
  if (!ok)
    for (std::size_t c = 0; c < contestants.size(); ++c) record.strategies[c] = describe(contestants[c]);
  print(record.verification, options.elementary);
  output.commit(json_text(to_json(record)));
  std::printf("%s", run_times_text(record).c_str());
  return ok;
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
  std::vector<RunOptions> runs;
  std::deque<OutputFile> outputs;  // what stands in the way of any is found before the work
  for (const scenes::SceneSummary& scene : all) {
    runs.push_back(options);
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
  if (pipeline_named(options.pipeline) == Pipeline::published && options.elementary != kPublishedTest)
    throw InputError("--pipeline published --elementary " + options.elementary +
                     ": the paper's elementary test is a part of that pipeline; leave --elementary out");
  elementary_test_named(options.elementary);
  for (const std::string& name : options.strategies)  // before anything is opened
    if (strategies_in(name).empty()) strategy_named(name);
  if (options.scene == kAllScenes) {
    if (!run_all(options)) throw kVerificationFailed;
    return;
  }
  OutputFile output(options.output, options.force);
  const bool ok = run_one(options, output);
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
  command->add_option("--scene,--input", options->scene, kInputHelp)->capture_default_str();
  command
      ->add_option("--strategy", options->strategies,
                   "strategies or groups of them, with commas between; default all without a group")
      ->delimiter(',');
  command->add_option("--elementary", options->elementary, "the elementary test that is timed")
      ->capture_default_str();
  command
      ->add_option(
          "--pipeline", options->pipeline,
          "`published` measures the paper's rows with the paper's code: scalar refit and orientation, "
          "its\nfilter alone, one feature pair after the other; `today` with this project's")
      ->capture_default_str();
  command->add_option("--repetitions", options->repetitions, "how often each interval is timed")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command
      ->add_option("--count-every", options->count_every,
                   "take the counters of each K-th interval, and of those timed or verified")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  command->add_option("--time-every", options->time_every, "time each K-th interval")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  command
      ->add_option("--time-contacts", options->time_contacts,
                   "time at least so many intervals with contacts, where there are that many")
      ->check(CLI::Range(0, 1000000))
      ->capture_default_str();
  command->add_option("--frames", options->frames, "A:B, the intervals between frames A and B; default all");
  command
      ->add_option("--verify-every", options->verify_every,
                   "verify each K-th interval, from the first, and all that are timed")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  command->add_option("--seed", options->seed, "of the order in which strategies run")->capture_default_str();
  command->add_flag("--smoke", options->smoke,
                    "8 intervals in the middle, every 4th of them verified and timed twice");
  command
      ->add_option("--json", options->output,
                   "where the record goes, - is standard output; with --scene all, the folder of the records")
      ->required();
  command->add_flag("--force", options->force, "replace the output if it exists");
  add_threads_option(*command, options->threads);
  add_model_options(*command, options->model);
  command->callback([options] { run(*options); });
}

}  // namespace cscd::bench
