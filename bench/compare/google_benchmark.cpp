#include "bench/compare/google_benchmark.h"

#include <filesystem>

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

}  // namespace cscd::bench
