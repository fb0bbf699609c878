#include "bench/compare/side.h"

#include <algorithm>
#include <filesystem>

#include "bench/compare/settings.h"
#include "core/base/error.h"
#include "scenes/base/files_in.h"

namespace cscd::bench {

namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

void add_file(const fs::path& path, bool named_itself, std::vector<Record>& records) {
  const ordered_json document = read_document(path);
  if (is_google_benchmark(document)) {
    records.push_back(record_from_google_benchmark(document, path.string()));
    return;
  }
  const bool is_record =
      document.is_object() && document.contains("schema") && document["schema"] == kRunSchema;
  if (is_record || named_itself) records.push_back(record_from(document, path.string()));
}

void add_named(const fs::path& path, std::vector<Record>& records) {
  std::error_code error;
  if (!fs::is_directory(path, error)) return add_file(path, true, records);
  const std::size_t before = records.size();
  for (const fs::path& file : files_in(path, {".json", ".json.gz"})) add_file(file, false, records);
  if (records.size() == before)
    throw InputError("folder " + path.string() +
                     ": holds no record; name one into which `cscd run --json` wrote");
}

double milliseconds_per(const std::string& unit, const std::string& where) {
  if (unit == "ns") return 1e-6;
  if (unit == "us") return 1e-3;
  if (unit == "ms") return 1;
  if (unit == "s") return 1e3;
  throw InputError(where + ": its time unit is " + unit + "; use ns, us, ms or s");
}

}  // namespace

std::string environment_text(const ordered_json& environment, const char* key) {
  if (!environment.contains(key)) return "unknown";
  const ordered_json& value = environment[key];
  return value.is_string() ? value.get<std::string>() : value.dump();
}

std::string layout_of(const Record& record) {
  return record.environment.contains("layout") ? environment_text(record, "layout") : "0";
}

Side side_of(std::vector<Record> records, const std::string& named) {
  if (records.empty()) throw InputError(named + ": names no record; name what `cscd run` wrote");
  std::ranges::stable_sort(records, [](const Record& a, const Record& b) {
    return environment_text(a, "date") < environment_text(b, "date");
  });
  Side side;
  side.commit = environment_text(records.front(), "commit");
  side.measured = environment_text(records.front(), "date");
  for (Record& record : records) {
    if (const std::string commit = environment_text(record, "commit"); commit != side.commit)
      throw InputError(named + ": holds records of two commits, " + side.commit.substr(0, 12) + " and " +
                       commit.substr(0, 12) + "; name those of one");
    side.dirty = side.dirty || record.environment.value("dirty", false);
    // The pipelines answer the same and take different times, so their records are no repetitions.
    const std::string name =
        record.scene.name + (record.pipeline == Pipeline::published ? " (pipeline published)" : "");
    std::vector<Record>& processes = side.scenes[name];
    if (!processes.empty())
      if (const std::string settings = other_settings(processes.front(), record); !settings.empty())
        throw InputError(named + ": holds two records of " + record.scene.name + " with other settings (" +
                         settings + "), which are no repetitions of one measurement; name those of one");
    processes.push_back(std::move(record));
  }
  return side;
}

Side read_side(const std::string& named) {
  std::vector<Record> records;
  std::stringstream words(named);
  for (std::string word; std::getline(words, word, ',');)
    if (!word.empty()) add_named(word, records);
  return side_of(std::move(records), named);
}

bool is_google_benchmark(const ordered_json& document) {
  return document.is_object() && document.contains("context") && document.contains("benchmarks");
}

Record record_from_google_benchmark(const ordered_json& document, const std::string& where) try {
  Record record;
  const ordered_json& context = document.at("context");
  const std::string executable = context.value("executable", std::string("benchmark"));
  record.environment = {{"date", context.value("date", std::string("unknown"))},
                        {"commit", context.value("cscd_commit", std::string("unknown"))},
                        {"dirty", false},
                        {"cpu", context.value("host_name", std::string("unknown"))},
                        {"cores", context.value("num_cpus", 0)}};
  record.command = {executable};
  record.scene.name = std::filesystem::path(executable).filename().string();
  record.intervals = 1;
  record.timed_intervals = {0};
  for (const ordered_json& run : document.at("benchmarks")) {
    if (run.value("run_type", std::string("iteration")) != "iteration") continue;
    if (run.value("error_occurred", false)) continue;
    const std::string name = run.value("run_name", run.at("name").get<std::string>());
    StrategyRecord* row = nullptr;
    for (StrategyRecord& known : record.strategies)
      if (known.name == name) row = &known;
    if (row == nullptr) {
      row = &record.strategies.emplace_back();
      row->name = name;
      row->guarantee = "heuristic";
    }
    row->ms["traversal"].push_back({run.at("real_time").get<double>() *
                                    milliseconds_per(run.value("time_unit", std::string("ns")), where)});
  }
  return record;
} catch (const nlohmann::json::exception& error) {
  throw InputError(where + ": is not what Google Benchmark writes (" + error.what() +
                   "); write it anew with --benchmark_format=json");
}

}  // namespace cscd::bench
