#include "bench/compare/side.h"

#include <gtest/gtest.h>

#include "bench/compare/comparison.h"
#include "bench/compare/test_records.h"
#include "core/base/error.h"

namespace cscd::bench {
namespace {

using nlohmann::ordered_json;

// As Google Benchmark 1.7 writes it, with repetitions and an aggregate.
constexpr char kWritten[] = R"({
  "context": {"date": "2026-11-25T12:00:00+00:00", "host_name": "h", "executable": "./build/cscd_kernels",
              "num_cpus": 2, "mhz_per_cpu": 2400, "cpu_scaling_enabled": false, "caches": [],
              "load_avg": [0.1], "library_build_type": "release"},
  "benchmarks": [
    {"name": "sort/8", "run_name": "sort/8", "run_type": "iteration", "repetitions": 2, "repetition_index": 0,
     "threads": 1, "iterations": 100, "real_time": 2000.0, "cpu_time": 1990.0, "time_unit": "ns"},
    {"name": "sort/8", "run_name": "sort/8", "run_type": "iteration", "repetitions": 2, "repetition_index": 1,
     "threads": 1, "iterations": 100, "real_time": 3.0, "cpu_time": 2.9, "time_unit": "us"},
    {"name": "sort/8_mean", "run_name": "sort/8", "run_type": "aggregate", "aggregate_name": "mean",
     "repetitions": 2, "threads": 1, "iterations": 2, "real_time": 2500.0, "cpu_time": 2445.0, "time_unit": "ns"}
  ]})";

TEST(GoogleBenchmark, IsReadAsARecordWithoutTruth) {
  const ordered_json document = ordered_json::parse(kWritten);
  ASSERT_TRUE(is_google_benchmark(document));
  const Record record = record_from_google_benchmark(document, "a file");
  EXPECT_EQ(record.scene.name, "cscd_kernels");
  ASSERT_EQ(record.strategies.size(), 1u);
  EXPECT_EQ(record.strategies[0].name, "sort/8");
  EXPECT_EQ(record.strategies[0].ms.at("traversal"), (std::vector<std::vector<double>>{{0.002}, {0.003}}));
  ordered_json damaged = document;
  damaged["benchmarks"][0].erase("real_time");
  EXPECT_THROW(record_from_google_benchmark(damaged, "a file"), InputError);
  damaged = document;
  damaged["benchmarks"][0]["time_unit"] = "weeks";
  EXPECT_THROW(record_from_google_benchmark(damaged, "a file"), InputError);
}

TEST(GoogleBenchmark, FilesAreComparedWithoutTruth) {
  const Record record = record_from_google_benchmark(ordered_json::parse(kWritten), "a file");
  std::vector<Record> before, after;
  for (int i = 0; i < 8; ++i) {
    before.push_back(record);
    after.push_back(record);
    before.back().environment["date"] = after.back().environment["date"] =
        "2026-11-25T12:00:0" + std::to_string(i);
    for (auto& repetition : after.back().strategies[0].ms["traversal"]) repetition[0] *= 1.5;
  }
  const Comparison comparison = compare(side_of(before, "OLD"), side_of(after, "NEW"), Lane::all);
  EXPECT_EQ(comparison.verdict(), ComparisonVerdict::worse) << comparison_text(comparison);
}

}  // namespace
}  // namespace cscd::bench
