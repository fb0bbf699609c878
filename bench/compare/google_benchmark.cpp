#include "bench/compare/google_benchmark.h"

#include <cstdio>
#include <filesystem>
#include <map>

#include "bench/compare/stage_samples.h"
#include "bench/compare/statistics/statistics.h"
#include "core/base/error.h"

namespace cscd::bench {
namespace {

using nlohmann::ordered_json;

double milliseconds_per(const std::string& unit, const std::string& where) {
  if (unit == "ns") return 1e-6;
  if (unit == "us") return 1e-3;
  if (unit == "ms") return 1;
  if (unit == "s") return 1e3;
  throw InputError(where + ": its time unit is " + unit + "; use ns, us, ms or s");
}

// Calls `each` with scene, row, stage and milliseconds a repetition.
template <class Each>
void for_each_stage(std::span<const Record> records, const Each& each) {
  for (const Record& record : records)
    for (const StrategyRecord& row : record.strategies)
      for (const std::string& stage : stages_of(row)) {
        const std::vector<double> samples = stage_samples(record, row, stage);
        if (!samples.empty()) each(record.scene.name, row.name, stage, samples);
      }
}

}  // namespace

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

ordered_json google_benchmark_json(std::span<const Record> records) {
  ordered_json benchmarks = ordered_json::array();
  for_each_stage(records, [&](const std::string& scene, const std::string& row, const std::string& stage,
                              const std::vector<double>& samples) {
    const std::string name = scene + "/" + row + "/" + stage;
    for (std::size_t i = 0; i < samples.size(); ++i)
      benchmarks.push_back({{"name", name},
                            {"run_name", name},
                            {"run_type", "iteration"},
                            {"repetitions", samples.size()},
                            {"repetition_index", i},
                            {"threads", 1},
                            {"iterations", 1},
                            {"real_time", samples[i]},
                            {"cpu_time", samples[i]},
                            {"time_unit", "ms"}});
  });
  const ordered_json environment = records.empty() ? ordered_json::object() : records.front().environment;
  return {{"context",
           {{"date", environment.value("date", "unknown")},
            {"host_name", environment.value("cpu", "unknown")},
            {"executable", "cscd"},
            {"num_cpus", environment.value("cores", 0)},
            {"mhz_per_cpu", 0},
            {"cpu_scaling_enabled", false},
            {"caches", ordered_json::array()},
            {"library_build_type", "release"},
            {"cscd_commit", environment.value("commit", "unknown")}}},
          {"benchmarks", std::move(benchmarks)}};
}

ordered_json github_action_json(std::span<const Record> records) {
  ordered_json out = ordered_json::array();
  for_each_stage(records, [&](const std::string& scene, const std::string& row, const std::string& stage,
                              const std::vector<double>& samples) {
    const Estimate estimate = bootstrap_median(samples);
    char range[32];
    std::snprintf(range, sizeof range, "± %.3g", (estimate.high - estimate.low) / 2);
    out.push_back({{"name", scene + "/" + row + "/" + stage},
                   {"unit", "ms"},
                   {"value", estimate.value},
                   {"range", range}});
  });
  return out;
}

}  // namespace cscd::bench
