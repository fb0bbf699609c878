#include <CLI/App.hpp>
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "bench/command_line/add_options.h"
#include "bench/command_line/command.h"
#include "bench/compare/history.h"
#include "bench/compare/times.h"
#include "bench/output/data.h"
#include "bench/output/output.h"
#include "bench/output/schema.h"
#include "bench/query/view/html.h"
#include "bench/query/view_page.h"
#include "bench/records/record.h"
#include "bench/records/shortfall.h"
#include "bench/statistics/statistics.h"
#include "bench/tables/claims.h"
#include "bench/tables/filled_tables.h"
#include "bench/tables/record_inputs.h"
#include "bench/tables/shaped_table.h"
#include "bench/tables/studies_json.h"
#include "bench/tables/tables_json.h"
#include "core/base/error.h"

namespace cscd::bench {
namespace {

using nlohmann::json;

struct ReportOptions {
  std::vector<std::string> records;
  std::string folder, history, json;
  bool views = false, force = false;
};

// The only record of a study; null where none was named.
const RecordFile* only_record(const RecordFiles& files, const std::string& study) {
  const auto found = files.find(study);
  if (found == files.end()) return nullptr;
  if (found->second.size() > 1)
    throw InputError("record " + found->second[1].path.string() +
                     ": a second record of this study; give one");
  return &found->second.front();
}

// Of a stage, the mean over the timed intervals, and of the repetitions the median.
json strategy_of(const Record& record, const StrategyRecord& strategy) {
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
  for (const std::string_view stage : kQueryStages)
    if (const auto samples = stage_samples(record, strategy, std::string(stage)); !samples.empty())
      stages[std::string(stage)] = median(samples);
  return {{"name", strategy.name},
          {"guarantee", strategy.guarantee},
          {"counts", counts},
          {"stages", stages},
          {"marked", shortfall(record, strategy.name).has_value()}};
}

// What the page says of the record of a study, where there is one: its environment, the command that made
// it, and its points.
json study_json(const RecordFile* file, const char* schema_file, json (*points)(const json& record),
                const std::function<std::string(std::string)>& link) {
  if (file == nullptr) return nullptr;
  if (const std::string violation = schema_violation(file->document, schema_file); !violation.empty())
    throw InputError("record " + file->path.string() + ": does not follow its schema at " + violation);
  return {{"file", link(file->path)},
          {"command", file->document.at("command")},
          {"environment", file->document.at("environment")},
          {"data", points(file->document)}};
}

// Writes a page of the viewer beside the report for every scene of the records. Returns the pages by scene.
json write_views(const std::vector<Record>& records, const std::filesystem::path& folder, bool force) {
  json views = json::object();
  for (const Record& record : records) {
    if (!record.scene.path.empty() || record.thickness > 0 || views.contains(record.scene.name)) continue;
    const std::string file = record.scene.name + ".html";
    OutputFile output(folder / file, force, ".html");
    ViewRequest request;
    request.input = record.scene.name;
    for (const char* strategy : {"drvbc_fast", "drvbc"})
      if (record.strategy(strategy) != nullptr) request.strategies.emplace_back(strategy);
    output.commit(view_page(request));
    views[record.scene.name] = file;
  }
  return views;
}

// A record that was made with the paper's code around every method says so.
json record_json(const Record& record, const std::string& file) {
  json strategies = json::array();
  for (const StrategyRecord& strategy : record.strategies)
    strategies.push_back(strategy_of(record, strategy));
  return {{"scene", record.scene.name},
          {"pipeline", to_string(record.pipeline)},
          {"file", file},
          {"own", !record.scene.path.empty()},  // a user's own scene, whatever its name
          {"counted_intervals", record.counted_intervals},
          {"colliding", record.verification.colliding},
          {"strategies", std::move(strategies)}};
}

// What the page shows, with links from its folder.
json document_of(const ReportOptions& options, const RecordFiles& files, const std::vector<Record>& records,
                 const std::vector<RecordFile>& runs) {
  const auto link = [&](const std::string& path) {
    std::error_code error;
    const std::filesystem::path file = std::filesystem::relative(path, options.folder, error);
    return error ? path : file.generic_string();
  };
  json rows = json::array(), history, looks = data_json("looks.json");
  looks.erase("comment");
  for (std::size_t r = 0; r < records.size(); ++r)
    rows.push_back(record_json(records[r], link(runs[r].path)));
  std::string command = "cscd report";
  for (const std::string& path : options.records)
    command += " " + std::filesystem::path(path + "/").parent_path().filename().string();
  if (!options.history.empty()) {
    command += " --history " + std::filesystem::path(options.history).lexically_normal().filename().string();
    history = courses_json(read_courses(options.history, {"", "", "", std::string(kSpeedupStage)}));
    history["folder"] = link(options.history);
  }
  if (options.views) command += " --view";
  if (!options.folder.empty()) command += " -o " + std::filesystem::path(options.folder).filename().string();
  json tables;
  if (!records.empty()) {
    const std::vector<FilledTable> made = filled_tables(records);
    tables = tables_json(made, shaped_tables(made, records), judge_claims(records), records);
  }
  return {
      {"schema", "cscd.report/2"},
      {"base", ""},
      {"command", command},
      {"records", std::move(rows)},
      {"looks", std::move(looks)},
      {"tables", std::move(tables)},
      {"accuracy", study_json(only_record(files, "accuracy"), "accuracy.schema.json", accuracy_json, link)},
      {"growth", study_json(only_record(files, "scale"), "scale.schema.json", growth_json, link)},
      {"history", std::move(history)},
      {"views", json::object()}};
}

void report(const ReportOptions& options) {
  const bool is_page = !options.folder.empty();
  if (!is_page && options.json.empty())
    throw InputError("--out or --json: one of them has to say where the report goes");
  if (is_page) require_viewer();
  RecordFiles files = record_files(options.records, {"run", "accuracy", "scale"}, !is_page);
  std::vector<RecordFile> runs = std::move(files["run"]);
  const std::vector<Record> records = read_records(runs);
  OutputFile document(options.json, options.force);
  std::optional<OutputFile> output;
  const std::filesystem::path folder(options.folder), page = folder / "index.html";
  if (is_page) {
    make_folder(folder, "--out");
    output.emplace(page, options.force, ".html");
  }
  json shown = document_of(options, files, records, runs);
  document.commit(shown.dump() + "\n");
  if (!is_page) return;
  if (options.views) shown["views"] = write_views(records, folder, options.force);
  const std::string text = report_with(shown);
  output->commit(text);
  std::printf("%s: %.1f MB of %zu records; open it in a browser\n", page.c_str(),
              static_cast<double>(text.size()) / 1e6, records.size());
}

}  // namespace

void add_report(CLI::App& app) {
  auto options = std::make_shared<ReportOptions>();
  CLI::App* command = app.add_subcommand(
      "report",
      "Write one HTML page of the numbers in records: speed, work per interval, stage times, the paper's\n"
      "tables published beside measured, its claims, accuracy against time, growth and history.\n\n"
      "  cscd report results/FOLDER --view -o site\n"
      "  cscd report results/FOLDER --json figures.json    the same as data; also of cscd accuracy or cscd "
      "scale alone\n\n"
      "The page, site/index.html, needs no network. Every figure names the records that it comes from.");
  using R = ReportOptions;
  static const OptionRow<R> rows[] = {
      required<R>({"records", &R::records,
                   "what cscd run wrote, at most one a scene and pipeline; and what cscd accuracy and cscd "
                   "scale wrote; or folders of these"}),
      {"--history", &R::history, "a folder of entries of cscd history, such as results/history, to show too"},
      {"--view", &R::views,
       "write a page of cscd view for every scene too: the interval under the pointer is shown in it"},
      {"-o,--out", &R::folder, "the folder for the page; made where it is missing"},
      {"--json", &R::json,
       "where all that the page shows goes as JSON; - is standard output. Without a page, no "
       "record of cscd run has to be there"},
      {"--force", &R::force, "replace the page if it exists"}};
  add_options<R>(*command, rows, *options);
  command->callback([options] { report(*options); });
}

}  // namespace cscd::bench
