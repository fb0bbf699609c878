#include <CLI/App.hpp>

#include "bench/cli/command_line/command.h"
#include "bench/cli/output/json_text.h"
#include "bench/cli/output/output.h"
#include "bench/compare/google_benchmark.h"
#include "bench/compare/side.h"

namespace cscd::bench {
namespace {

struct ConvertOptions {
  std::string records, format, output;
  bool force = false;
};

void convert(const ConvertOptions& options) {
  OutputFile output(options.output, options.force);
  const Side side = read_side(options.records);
  std::vector<Record> records;
  for (const auto& [scene, of_scene] : side.scenes)
    records.insert(records.end(), of_scene.begin(), of_scene.end());
  output.commit(json_text(options.format == "google-benchmark" ? google_benchmark_json(records)
                                                               : github_action_json(records)));
}

}  // namespace

void add_convert(CLI::App& app) {
  auto options = std::make_shared<ConvertOptions>();
  CLI::App* command = app.add_subcommand(
      "convert",
      "Write the times of records in the format of another tool.\n\n"
      "  cscd convert rope.json --to google-benchmark --json rope-gb.json    for Google Benchmark's "
      "compare.py\n"
      "  cscd convert records --to github-action --json -                    for github-action-benchmark\n\n"
      "`cscd compare` reads Google Benchmark's files as it reads records, without truth and counters.");
  command->add_option("records", options->records, "records: files or folders, commas between")->required();
  command->add_option("--to", options->format, "google-benchmark, or github-action (customSmallerIsBetter)")
      ->check(CLI::IsMember({"google-benchmark", "github-action"}))
      ->required();
  command->add_option("--json", options->output, "where it goes; - is standard output")->required();
  command->add_flag("--force", options->force, "replace the output if it exists");
  command->callback([options] { convert(*options); });
}

}  // namespace cscd::bench
