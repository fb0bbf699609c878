#include <CLI/App.hpp>
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "bench/command_line/command.h"
#include "bench/compare/history.h"
#include "bench/compare/times.h"
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
#include "bench/tables/run_times.h"
#include "bench/tables/shaped_table.h"
#include "bench/tables/tables_json.h"
#include "core/base/error.h"

namespace cscd::bench {
namespace {

using nlohmann::json;

struct Sum {
  std::uint64_t queries = 0, lost = 0, invented = 0, undecided = 0, timed = 0;
  double ns = 0;  // of all timed queries, each as long as the median of its class
};

// Accuracy against time, from a record of `cscd accuracy`: for each group of workloads and each elementary
// test the numbers of queries, of contacts that it lost, of contacts that it invented, of those that it left
// undecided, and the mean time of a query in nanoseconds (null where nothing was timed).
json accuracy_points(const json& record) {
  std::map<std::string, bool> is_sweep;
  for (const json& row : record.at("rows")) is_sweep[row.at("name")] = row.at("sweep");
  std::map<std::pair<std::string, std::string>, Sum> sums;  // by group and test
  for (const json& workload : record.at("workloads"))
    for (const json& row : workload.at("rows")) {
      if (row.at("queries") == 0) continue;
      Sum& sum = sums[{workload.at("group"), row.at("row")}];
      const auto add = [&](std::uint64_t& to, const char* key) { to += row.at(key).get<std::uint64_t>(); };
      add(sum.queries, "queries");
      add(sum.lost, "false_negatives");
      add(sum.invented, "false_positives");
      add(sum.undecided, "undecided_contacts");
      add(sum.undecided, "undecided_apart");
      for (const json& part : row.value("ns", json::object())) {
        const auto queries = part.at("queries").get<std::uint64_t>();
        sum.timed += queries;
        sum.ns += static_cast<double>(queries) * part.at("median").get<double>();
      }
    }
  json points = json::array();
  for (const auto& [place, sum] : sums)
    points.push_back({{"group", place.first},
                      {"row", place.second},
                      {"sweep", is_sweep[place.second]},
                      {"queries", sum.queries},
                      {"lost", sum.lost},
                      {"invented", sum.invented},
                      {"undecided", sum.undecided},
                      {"ns", sum.timed > 0 ? json(sum.ns / static_cast<double>(sum.timed)) : json()}});
  return points;
}

// The guarantee of a row of a subject of `cscd scale`.
std::string guarantee_of(const json& subject, const json& row) {
  for (const json& strategy : subject.at("strategies"))
    if (strategy.at("name") == row.at("name")) return strategy.at("guarantee");
  return "";
}

// Whether a row answers less than a complete row in a step of `cscd scale`. The record says it. Of an older
// one it follows from the contacts that complete rows count in as many intervals, and from starts from which
// the row promises nothing (scripts/lib/scale_record.py has the same rule).
bool answers_less(const json& subject, const json& step, const json& row) {
  constexpr std::string_view kComplete = "complete", kFirst = " --first";
  const std::string guarantee = guarantee_of(subject, row);
  if (row.contains("shortfall") || guarantee == kComplete) return row.contains("shortfall");
  const std::size_t starts = step.at("starts").size(),
                    good = step.value("clear", step.at("embedded").get<std::size_t>());
  if (needs_embedded_start(guarantee) && good < starts) return true;
  if (row.at("name").get<std::string>().ends_with(kFirst)) return false;  // is asked for no later contact
  const double found = row.at("counts").value("contacts", 0.0);           // the mean
  bool is_judged = false, is_less = false;
  for (const json& other : step.at("strategies")) {
    if (guarantee_of(subject, other) != kComplete || other.at("name").get<std::string>().ends_with(kFirst) ||
        other.at("intervals") != row.at("intervals"))
      continue;
    is_judged = true;
    is_less = is_less || found < other.at("counts").value("contacts", 0.0);
  }
  return is_judged ? is_less : step.at("colliding") > 0;
}

// How cost grows, from a record of `cscd scale`: for each study, scene and strategy the milliseconds of a
// query at each size, and the exponent of the power law through them where one was fitted. A size is a number
// of triangles, of bones or of threads, or a length of step.
json growth_points(const json& record) {
  json points = json::array();
  for (const json& subject : record.at("subjects")) {
    const std::string study = subject.at("study");
    if (study == "contacts") continue;  // ratios of two scenes, at one size
    for (const json& step : subject.at("steps"))
      for (const json& strategy : step.at("strategies")) {
        if (!strategy.contains("ms")) continue;  // its answers were not verified
        const json& size = study == "step"        ? step.at("step")
                           : study == "bones"     ? subject.at("bones")
                           : study == "threads"   ? subject.at("threads")
                           : study == "thickness" ? step.at("thickness")
                                                  : subject.at("triangles");
        points.push_back({{"study", study},
                          {"scene", subject.at("scene")},
                          {"strategy", strategy.at("name")},
                          {"size", size},
                          {"ms", strategy.at("ms").at("total")},
                          {"marked", answers_less(subject, step, strategy)}});
      }
  }
  json fits = json::array();
  for (const json& fit : record.at("fits"))
    if (fit.at("quantity") == "total" && !fit.at("exponent").is_null())
      fits.push_back({{"study", fit.at("study")},
                      {"scene", fit.at("scene")},
                      {"strategy", fit.at("strategy")},
                      {"exponent", fit.at("exponent")}});
  return {{"points", std::move(points)}, {"fits", std::move(fits)}};
}

struct ReportOptions {
  std::vector<std::string> records;
  std::string folder, history;
  bool views = false, force = false;
};

constexpr std::string_view kAccuracySchema = "cscd.accuracy/1", kScaleSchema = "cscd.scale/1";

// The only record of a study; an empty path where none was named.
std::filesystem::path only_record(const RecordFiles& files, std::string_view schema) {
  const auto found = files.find(std::string(schema));
  if (found == files.end()) return {};
  if (found->second.size() > 1)
    throw InputError("record " + found->second[1].string() + ": a second record of this study; give one");
  return found->second.front();
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
  for (const char* stage : {"refit", "rv_update", "traversal", "elementary"})
    if (const auto samples = stage_samples(record, strategy, stage); !samples.empty())
      stages[stage] = median(samples);
  return {{"name", strategy.name}, {"guarantee", strategy.guarantee}, {"counts", counts}, {"stages", stages}};
}

// What the page says of the record of a study, where there is one: its environment, the command that made
// it, and its points.
json study_json(const std::filesystem::path& path, const char* schema_file,
                json (*points)(const json& record), const std::function<std::string(std::string)>& link) {
  if (path.empty()) return nullptr;
  const json record = json::parse(record_text(path));
  if (const std::string violation = schema_violation(record, schema_file); !violation.empty())
    throw InputError("record " + path.string() + ": does not follow its schema at " + violation);
  return {{"file", link(path)},
          {"command", record.at("command")},
          {"environment", record.at("environment")},
          {"data", points(record)}};
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

void report(const ReportOptions& options) {
  require_viewer();
  constexpr std::array<std::string_view, 3> wanted = {kRunSchema, kAccuracySchema, kScaleSchema};
  const RecordFiles files = record_files(options.records, wanted);
  const std::filesystem::path accuracy = only_record(files, kAccuracySchema),
                              scale = only_record(files, kScaleSchema);
  std::vector<std::filesystem::path> runs = files.at(std::string(kRunSchema));
  const std::vector<Record> records = read_records(runs);
  const std::filesystem::path folder(options.folder), page = folder / "index.html";
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error)
    throw InputError("--out " + options.folder + ": the folder cannot be made (" + error.message() +
                     "); choose another place");
  OutputFile output(page, options.force, ".html");

  // The page links to the record from where it lies.
  const auto link = [&](const std::string& path) {
    const std::filesystem::path file = std::filesystem::relative(path, folder, error);
    return error ? path : file.generic_string();
  };
  json rows = json::array();
  std::string command = "cscd report";
  for (const std::string& path : options.records)
    command += " " + std::filesystem::path(path + "/").parent_path().filename().string();
  for (std::size_t r = 0; r < records.size(); ++r) {
    const Record& record = records[r];
    json strategies = json::array();
    for (const StrategyRecord& strategy : record.strategies)
      strategies.push_back(strategy_of(record, strategy));
    // A record made with the paper's code around every method says so.
    rows.push_back({{"scene", record.scene.name},
                    {"pipeline", to_string(record.pipeline)},
                    {"file", link(runs[r])},
                    {"counted_intervals", record.counted_intervals},
                    {"strategies", std::move(strategies)}});
  }
  json history;
  if (!options.history.empty()) {
    command += " --history " + std::filesystem::path(options.history).lexically_normal().filename().string();
    history = courses_json(read_courses(options.history, {"", "", "", "total"}));
    history["folder"] = link(options.history);
  }
  if (options.views) command += " --view";
  const std::vector<FilledTable> made = filled_tables(records);
  std::vector<ShapedTable> shaped = shaped_tables(made, records);
  shaped.push_back(times_of_strategies(records));
  std::string caution;  // the first that any record gives
  for (const Record& record : records)
    if (caution.empty()) caution = no_claims_text(record);
  const std::string text =
      report_with({{"schema", "cscd.report/1"},
                   {"base", ""},
                   {"command", command + " -o " + folder.filename().string()},
                   {"records", std::move(rows)},
                   {"shaped", shaped_json(shaped)},
                   {"mark_note", kMarkNote},
                   {"caution", caution},
                   {"tables", tables_json(made, judge_claims(records), records)},
                   {"accuracy", study_json(accuracy, "accuracy.schema.json", accuracy_points, link)},
                   {"growth", study_json(scale, "scale.schema.json", growth_points, link)},
                   {"history", std::move(history)},
                   {"views", options.views ? write_views(records, folder, options.force) : json::object()}});
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
      "published beside measured, its claims, accuracy against time, growth and history.\n\n"
      "  cscd report results/FOLDER --view -o site\n\n"
      "The page, site/index.html, needs no network. Every figure names the records that it comes from.");
  command
      ->add_option("records", options->records,
                   "what cscd run wrote, at most one a scene and pipeline; and what cscd accuracy and cscd "
                   "scale wrote; or folders of these")
      ->required();
  command->add_option("--history", options->history,
                      "a folder of entries of cscd history, such as results/history, to show too");
  command->add_flag(
      "--view", options->views,
      "write a page of cscd view for every scene too: the interval under the pointer is shown in "
      "it");
  command->add_option("-o,--out", options->folder, "the folder for the page; made where it is missing")
      ->required();
  command->add_flag("--force", options->force, "replace the page if it exists");
  command->callback([options] { report(*options); });
}

}  // namespace cscd::bench
