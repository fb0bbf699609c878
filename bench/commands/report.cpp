#include <CLI/App.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <numeric>
#include <vector>

#include "bench/commands/command.h"
#include "bench/output/output.h"
#include "bench/statistics/statistics.h"
#include "bench/tables/claims.h"
#include "bench/tables/paper_tables.h"
#include "bench/tables/record_inputs.h"
#include "bench/tables/tables_text.h"
#include "bench/view/html.h"
#include "core/base/error.h"

namespace cscd::bench {
namespace {

using nlohmann::json;

struct ReportOptions {
  std::vector<std::string> records;
  std::string folder;
  bool force = false;
};

// The mean over the timed intervals, and of the repetitions the median.
double typical(const std::vector<std::vector<double>>& repetitions) {
  std::vector<double> means;
  for (const std::vector<double>& intervals : repetitions)
    means.push_back(std::accumulate(intervals.begin(), intervals.end(), 0.0) /
                    static_cast<double>(std::max<std::size_t>(1, intervals.size())));
  return median(means);
}

json strategy_of(const StrategyRecord& strategy) {
  json counts = json::object(), stages;
  for (const char* counter : {"bvot", "pctp", "elementary_tests"})
    if (const auto column = strategy.counts.find(counter); column != strategy.counts.end())
      counts[counter] = column->second;
  const auto negative = strategy.counts.find("negative"), uncertain = strategy.counts.find("uncertain");
  if (negative != strategy.counts.end() && uncertain != strategy.counts.end()) {
    std::vector<std::uint64_t> sum = negative->second;
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += uncertain->second[i];
    counts["not_positive"] = sum;
  }
  for (const char* stage : {"refit", "rv_update", "traversal", "elementary"})
    if (const auto column = strategy.ms.find(stage); column != strategy.ms.end() && !column->second.empty())
      stages[stage] = typical(column->second);
  return {{"name", strategy.name}, {"guarantee", strategy.guarantee}, {"counts", counts}, {"stages", stages}};
}

void report(const ReportOptions& options) {
  require_viewer();
  const std::vector<Record> records = read_records(options.records);
  const std::filesystem::path folder(options.folder), page = folder / "index.html";
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error)
    throw InputError("--out " + options.folder + ": the folder cannot be made (" + error.message() +
                     "); choose another place");
  OutputFile output(page, options.force, ".html");

  json rows = json::array();
  std::string command = "cscd report";
  for (std::size_t r = 0; r < records.size(); ++r) {
    const Record& record = records[r];
    json strategies = json::array();
    for (const StrategyRecord& strategy : record.strategies) strategies.push_back(strategy_of(strategy));
    // The page links to the record from where it lies.
    const std::filesystem::path file = std::filesystem::relative(options.records[r], folder, error);
    rows.push_back({{"scene", record.scene.name},
                    {"pipeline", to_string(record.pipeline)},
                    {"file", error ? options.records[r] : file.generic_string()},
                    {"counted_intervals", record.counted_intervals},
                    {"strategies", std::move(strategies)}});
    command += " " + std::filesystem::path(options.records[r]).filename().string();
  }
  const json tables = tables_json(paper_tables(records), judge_claims(records), records);
  const std::string text = report_with({{"schema", "cscd.report/1"},
                                        {"base", ""},
                                        {"command", command + " -o " + folder.filename().string()},
                                        {"records", std::move(rows)},
                                        {"tables", tables}});
  output.commit(text);
  std::printf("%s: %.1f MB of %zu records; open it in a browser\n", page.c_str(),
              static_cast<double>(text.size()) / 1e6, records.size());
}

}  // namespace

void add_report(CLI::App& app) {
  auto options = std::make_shared<ReportOptions>();
  CLI::App* command = app.add_subcommand(
      "report",
      "Write one HTML page of the numbers in records: speed, work per interval, stage times, the paper's "
      "tables\n"
      "published beside measured, and its claims.\n\n"
      "  cscd report results/FOLDER/{rope,hand}*.json.gz -o site\n\n"
      "The page, site/index.html, needs no network. Every figure names the records that it comes from.");
  command->add_option("records", options->records, "what cscd run wrote, at most one a scene and pipeline")
      ->required();
  command->add_option("-o,--out", options->folder, "the folder for the page; made where it is missing")
      ->required();
  command->add_flag("--force", options->force, "replace the page if it exists");
  command->callback([options] { report(*options); });
}

}  // namespace cscd::bench
