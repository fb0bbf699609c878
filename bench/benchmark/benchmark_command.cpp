#include <CLI/App.hpp>
#include <cstdio>
#include <optional>

#include "bench/benchmark/benchmark.h"
#include "bench/benchmark/entry.h"
#include "bench/benchmark/judge.h"
#include "bench/command_line/add_options.h"
#include "bench/command_line/command.h"
#include "bench/output/json_text.h"
#include "bench/output/output.h"
#include "bench/output/progress.h"
#include "bench/strategies/catalogue.h"
#include "core/base/error.h"
#include "scenes/catalog/scene.h"

namespace cscd::bench {
namespace {

constexpr char kAll[] = "all", kNone[] = "none";

// The names that --scene stands for.
std::vector<std::string> scenes_called(const std::vector<std::string>& words) {
  if (words == std::vector<std::string>{kNone}) return {};
  if (words != std::vector<std::string>{kAll}) return words;
  return scenes::all_scene_names();
}

void add_make(CLI::App& benchmark) {
  struct Options : BenchmarkPlan {
    std::string out;
    std::vector<std::string> scene_words = {kAll};
    bool smoke = false;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command = benchmark.add_subcommand(
      "make",
      "Write intervals and their exact answers into a folder, for any program (bench/BENCHMARK.md).\n\n"
      "  cscd benchmark make --out benchmark\n"
      "  cscd benchmark make --out small --smoke\n"
      "  cscd benchmark make --out mine --count 200 --scene my/scene.json\n\n"
      "The same command writes the same bytes. `sha256sum -c SHA256SUMS` checks a copy.");
  using O = Options;
  static const OptionRow<O> rows[] = {
      required<O>({"--out", &O::out, "the folder; it is made where it is missing"}),
      {"--count", &O::small, "intervals of small meshes", {{1, 1'000'000}}},
      {"--seed", &O::seed, "the same seed gives the same small meshes"},
      {"--scene", &O::scene_words,
       "scenes, with commas between; all: every scene of cscd list; none: small meshes alone"},
      {"--scene-intervals", &O::scene_intervals, "intervals of each scene", {{1, 10'000}}},
      {"--smoke", &O::smoke,
       "seconds instead of minutes: 60 small meshes and no scenes, to show that everything works"},
      {"--force", &O::force, "replace a benchmark that is there"}};
  add_options<O>(*command, rows, *options);
  command->get_option("--scene")->default_str(kAll);
  command->get_option("--smoke")->excludes("--count")->excludes("--scene")->excludes("--scene-intervals");
  command->callback([options] {
    BenchmarkPlan& plan = *options;
    plan.folder = options->out;
    if (options->smoke) {
      plan.small = 60;
      options->scene_words = {kNone};
    }
    plan.scenes = scenes_called(options->scene_words);
    make_benchmark(plan, progress_of("benchmark"));
    const Benchmark made = read_benchmark(plan.folder);
    std::size_t touching = 0, crossing = 0, contacts = 0;
    std::uint64_t bytes = 0;
    for (const IntervalTruth& truth : read_truth(made)) {
      touching += truth.verdict() == "touches";
      crossing += !truth.starts_embedded();
      contacts += truth.contacts.size();
    }
    for (const ListedFile& file : made.files) bytes += file.bytes;
    std::printf(
        "%s: %zu intervals of %zu families, %zu touch and %zu intersect at their start; %zu contacts; "
        "%.1f MB\nmanifest %s\n",
        plan.folder.c_str(), made.intervals.size(), made.families.size(), touching, crossing, contacts,
        static_cast<double>(bytes) / 1e6, made.sha256.c_str());
  });
}

void add_answer(CLI::App& benchmark) {
  struct Options {
    std::string folder, strategy, elementary = "filtered_exact", output;
    std::size_t repetitions = 5;
    bool force = false;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command = benchmark.add_subcommand(
      "answer",
      "Answer a benchmark by a strategy of this program (cscd list), in the format that judge reads.\n\n"
      "  cscd benchmark answer benchmark --strategy embree --json embree.json\n"
      "  cscd benchmark answer benchmark --strategy base --elementary newton --json newton.json.gz\n"
      "  cscd benchmark answer benchmark --strategy \"drvbc_fast --first\" --json first.json\n\n"
      "Says how many intervals the strategy leaves out, and why. Every answer is verified before it is "
      "timed, as in\ncscd run. Exit status 1 where one breaks the strategy's promise; it then has no time.");
  using O = Options;
  static const OptionRow<O> rows[] = {
      required<O>({"benchmark", &O::folder, "the folder of a benchmark"}),
      required<O>({"--strategy", &O::strategy, "a strategy, or \"STRATEGY --first\""}),
      {"--elementary", &O::elementary, "elementary test (cscd list tests)"},
      required<O>({"--json", &O::output, "where the answers go; - is standard output"}),
      {"--repetitions",
       &O::repetitions,
       "how often each interval is asked; its time is the median",
       {{1, 1000}}},
      {"--force", &O::force, "replace the output if it exists"}};
  add_options<O>(*command, rows, *options);
  command->callback([options] {
    const std::vector<StrategyRow> rows = rows_called(std::vector<std::string>{options->strategy});
    if (rows.size() != 1)
      throw InputError("--strategy " + options->strategy + ": is a group of " + std::to_string(rows.size()) +
                       " strategies; name one of them");
    const ElementaryTest& elementary = elementary_test_named(options->elementary);
    OutputFile output(options->output, options->force);
    const Benchmark asked = read_benchmark(options->folder);
    Entry entry;
    {
      Progress progress("answers of " + rows[0].name(), asked.intervals.size());
      entry = answer_benchmark(asked, rows[0], elementary, options->repetitions,
                               [&](std::size_t done) { progress.set(done); });
    }
    std::printf("%s answers %zu of %zu intervals\n", entry.answers.program.c_str(),
                entry.answers.intervals.size(), asked.intervals.size());
    for (const auto& [reason, count] : entry.left_out)
      std::printf("  leaves out %zu: %s\n", count, reason.c_str());
    for (const std::string& failure : entry.failures)
      std::printf("  FAILED, so without a time: %s\n", failure.c_str());
    output.commit(to_json(entry.answers).dump() + "\n");
    if (!entry.failures.empty()) end_with(ExitStatus::failed);
  });
}

void add_judge(CLI::App& benchmark) {
  struct Options {
    std::string folder, answers, output;
    double time_tolerance = 0;
    bool families = false, force = false;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command = benchmark.add_subcommand(
      "judge",
      "Hold any program's answers against a benchmark: misses, inventions, errors of times, speed.\n\n"
      "  cscd benchmark judge benchmark answers.json\n"
      "  cscd benchmark judge benchmark answers.jsonl.gz --families\n"
      "  cscd benchmark judge benchmark answers.json --json - | jq .all\n\n"
      "bench/BENCHMARK.md describes the format of answers and defines every count. The exit status is 0 "
      "whatever\n"
      "the score; 2 for a damaged benchmark or malformed answers, with one line that says how to mend them.");
  using O = Options;
  static const OptionRow<O> rows[] = {
      required<O>({"benchmark", &O::folder, "the folder of a benchmark"}),
      required<O>({"answers", &O::answers, "the answers, as JSON or JSON lines"}),
      {.name = "--time-tolerance",
       .member = &O::time_tolerance,
       .help = "times that are off by no more than this share of the interval are neither late nor early",
       .range = {{0, 1}},
       .names_zero = true},
      {"--families", &O::families, "a row for each family instead of each set of them"}};
  add_options<O>(*command, rows, *options);
  add_output_options(*command, *options, "where the whole score goes; - is standard output");
  command->callback([options] {
    OutputFile output(options->output, options->force);
    const Benchmark judged = read_benchmark(options->folder);
    const Judgement judgement =
        judge(judged, read_answers(options->answers), "answers " + options->answers, options->time_tolerance);
    std::printf("%s", describe(judgement, options->families).c_str());
    output.commit(json_text(to_json(judgement)));
  });
}

}  // namespace

void add_benchmark(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("benchmark", "A public benchmark: make it, answer it, judge any program's answers.");
  command->require_subcommand(1);
  add_make(*command);
  add_answer(*command);
  add_judge(*command);
}

}  // namespace cscd::bench
