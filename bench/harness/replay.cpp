#include "bench/harness/replay.h"

#include <algorithm>
#include <filesystem>
#include <random>

#include "bench/harness/contestant.h"
#include "bench/harness/interval_choice.h"
#include "bench/harness/measurement.h"
#include "bench/inputs/input_options.h"
#include "bench/records/environment.h"
#include "bench/strategies/catalogue.h"
#include "core/base/error.h"
#include "core/base/pipeline.h"
#include "scenes/base/joined.h"
#include "scenes/catalog/plain_name.h"
#include "scenes/catalog/scene_cache.h"
#include "scenes/clip/digest.h"

namespace cscd::bench {
namespace {

// Judges culling, whatever test is timed. At a distance, the test in integers takes a millisecond a pair, so
// there the judge is the one that asks doubles first and is as right.
constexpr char kOracle[] = "exact", kOracleOfDistances[] = "filtered_exact";

// Enough to see that everything works, in seconds; too little to conclude anything from its times.
constexpr std::size_t kSmokeIntervals = 8, kSmokeRepetitions = 2, kSmokeEvery = 4;

// Returns the command line with every default spelt out, and without the place of the result.
std::vector<std::string> command_line(const ReplayRequest& options, const Input& input) {
  std::vector<std::string> words = {"cscd", "run", "--scene", options.scene};
  echo_options(replay_options(), options, words);
  if (input.ignored) echo_options(ignore_options(), input.ignored->asked, words);
  echo_options(thickness_options(), input.thickness.asked, words);
  if (input.import) echo_options(import_options(), options.model.import, words);
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

void leave_out_what_varies(Record& record) {
  record.environment = build_environment();
  record.scene.effects.clear();
  record.verification.seconds = 0;
  for (StrategyRecord& strategy : record.strategies) {
    strategy.preparation.distance_and_heat_ms.clear();
    strategy.preparation.decomposition_ms.clear();
  }
}

// Every K-th interval of the range, and intervals with contacts beside them, by the fastest complete
// strategy.
std::vector<std::size_t> intervals_to_time(Input& input, const IntervalRange& range,
                                           const ReplayRequest& request) {
  const std::vector<std::size_t> regular = every_kth(range, request.time_every);
  if (request.time_contacts == 0) return regular;
  const Prepared fastest = complete_fallback().make(
      measured_setup(input, complete_fallback(), elementary_test_named("filtered_exact")));
  return with_contacts(regular, intervals_with_contacts(input, *fastest.detector, range),
                       request.time_contacts);
}

}  // namespace

std::span<const OptionRow<ReplayRequest>> replay_options() {
  using R = ReplayRequest;
  static constexpr std::pair<double, double> kPositive{1, 1'000'000};
  static const OptionRow<R> rows[] = {
      {"--strategy", &R::strategies,
       "strategies or groups of them, with commas between; default all without a group. \"STRATEGY "
       "--first\"\n"
       "looks for the earliest contact alone"},
      {"--elementary", &R::elementary, "the elementary test that is timed"},
      {.name = "--pipeline",
       .member = &R::pipeline,
       .help =
           "`published` measures the paper's rows with the paper's code: scalar refit and orientation, its\n"
           "filter alone, one feature pair after the other; `today` with this project's",
       .choices = {"today", "published"}},
      {"--frames", &R::frames, "A:B, the intervals between frames A and B; default all"},
      {"--repetitions", &R::repetitions, "how often each interval is timed", {{1, 1000}}},
      {"--count-every", &R::count_every,
       "take the counters of each K-th interval, and of those timed or verified", kPositive},
      {"--time-every", &R::time_every, "time each K-th interval", kPositive},
      {"--time-contacts",
       &R::time_contacts,
       "time at least so many intervals with contacts, where there are that many",
       {{0, 1'000'000}}},
      {"--verify-every", &R::verify_every,
       "verify each K-th interval, from the first, and all that are timed", kPositive},
      {"--seed", &R::seed, "of the order in which strategies run"},
      {"--smoke", &R::smoke, "8 intervals in the middle, every 4th of them verified and timed twice"},
      {"--counts", &R::counts,
       "verdicts, counters and digests alone, which every machine repeats to the bit; no times"},
      threads_option<R>()};
  return rows;
}

void require_sound(const ReplayRequest& request) {
  if (pipeline_named(request.pipeline) == Pipeline::published && request.elementary != kPublishedTest)
    throw InputError("--pipeline published --elementary " + request.elementary +
                     ": the paper's elementary test is a part of that pipeline; leave --elementary out");
  elementary_test_named(request.elementary);
  rows_called(request.strategies);
}

Replay resolve(Input& input, const ReplayRequest& asked) {
  Replay replay{asked, {}, {}, {}};
  ReplayRequest& request = replay.request;
  IntervalRange range = parse_frames(request.frames, input);
  if (request.smoke) {
    if (range.last - range.first > kSmokeIntervals)  // those in the middle, where more happens
      range.first += (range.last - range.first - kSmokeIntervals) / 2;
    range.last = std::min(range.last, range.first + kSmokeIntervals);
    request.repetitions = kSmokeRepetitions;
    request.verify_every = request.time_every = kSmokeEvery;
    request.time_contacts = std::min<std::size_t>(request.time_contacts, 1);
    request.smoke = false;
  }
  request.frames = frames_text(range, input);
  if (!input.clip_was_named)  // so that the record says which clip it is of
    request.model.import.clip = std::to_string(input.import->chosen_clip);
  request.strategies.clear();
  for (const StrategyRow& row : chosen_rows(input, asked.strategies, pipeline_named(request.pipeline)))
    request.strategies.push_back(row.name());
  if (request.strategies.empty())
    throw InputError("--strategy: " + request.scene +
                     " allows none of these; name others (cscd list strategies)");
  replay.command = command_line(request, input);

  replay.range = range;
  Section& section = replay.section;
  section.thickness = input.thickness.length;
  if (!request.counts) section.timed = intervals_to_time(input, range, request);
  section.verified = united(std::vector{every_kth(range, request.verify_every), section.timed});
  section.counted = united(std::vector{every_kth(range, request.count_every), section.verified});
  return replay;
}

Record execute(Input& input, const Replay& replay) {
  const ElementaryTest& timed = elementary_test_named(replay.request.elementary);
  const ElementaryTest& exact =
      elementary_test_named(input.thickness.length > 0 ? kOracleOfDistances : kOracle);
  input.threads = replay.request.threads;

  Record record;
  record.environment = environment();
  record.command = replay.command;
  record.scene = describe(input);
  record.seed = replay.request.seed;
  record.pipeline = pipeline_named(replay.request.pipeline);
  record.elementary = timed.name;
  record.thickness = input.thickness.length;
  // Queries with a thickness are other work, which no table puts beside the scene's own.
  if (record.thickness > 0) record.scene.name += ", thickness " + input.thickness.asked.thickness.text;
  record.intervals = replay.range.last - replay.range.first;
  record.counted_intervals = replay.section.counted;
  record.timed_intervals = replay.section.timed;
  const bool is_timed = !replay.section.timed.empty();
  std::vector<Contestant> contestants =
      make_contestants(input, chosen_rows(input, replay.request.strategies, record.pipeline), exact, timed);
  Measurement measurement({input, contestants, exact, timed});
  SectionResult& measured = measurement.count(replay.section);
  std::mt19937_64 random(record.seed);
  if (is_timed && measured.verification.ok()) {
    measurement.time({replay.request.repetitions, random, true});
    for (std::size_t c = 0; c < contestants.size(); ++c) {
      Footprint& footprint = measured.rows[c].footprint;
      const std::optional<double> instructions = footprint.instructions;
      footprint =
          make_contestant(input, contestants[c].row, timed, timed, record.timed_intervals.front()).footprint;
      footprint.instructions = instructions;
    }
  }
  if (!measured.verification.ok())  // what was prepared is all that is left
    std::ranges::for_each(measured.rows, leave_out_measurements);
  record.verification = std::move(measured.verification);
  record.strategies = std::move(measured.rows);
  if (replay.request.counts) leave_out_what_varies(record);
  return record;
}

}  // namespace cscd::bench
