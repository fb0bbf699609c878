#pragma once

#include <string>
#include <vector>

#include "bench/records/record.h"
#include "bench/tables/filled_tables.h"
#include "bench/tables/shaped_table.h"

namespace cscd::bench {

// Records in which every table has long figures with long intervals.
inline Record wide_record(const std::string& scene, Pipeline pipeline) {
  Record record;
  record.environment = {{"cpu", "AMD EPYC"},       {"cores", 2},       {"compiler", "GNU 12"},
                        {"build_type", "Release"}, {"commit", "0123"}, {"date", "2026-11-25T22:40:26Z"}};
  record.scene.name = scene;
  record.scene.vertices = 24222, record.scene.triangles = 48440, record.scene.bones = 100;
  record.pipeline = pipeline;
  record.timed_intervals = {0};
  record.counted_intervals = {0};
  double ms = pipeline == Pipeline::vectorised ? 0.1234 : 1.2345;
  for (const char* name : {"base", "aabb", "mcd", "selfccd", "rvbc", "drvbc", "drvbc_fast",
                           "drvbc_fast_complete", "drvbc_fast_swept_bounds"}) {
    StrategyRecord row;
    row.name = name;
    row.guarantee = row.name.starts_with("drvbc") || row.name == "rvbc" ? "first_contact" : "complete";
    row.counts = {{"bvot", {1458321}},           {"pctp", {480123}},  {"negative", {1051}},
                  {"uncertain", {607}},          {"clusters", {176}}, {"feature_pairs", {6123456}},
                  {"elementary_tests", {123456}}};
    row.preparation.atomic_clusters = 199;
    row.preparation.distance_and_heat_ms = row.preparation.decomposition_ms = {1234.5, 2345.6};
    for (const char* stage : {"refit", "rv_update", "traversal", "elementary", "streaming"})
      row.ms[stage] = {{ms * 9.87}, {ms * 123.4}, {ms * 98.76}, {ms * 111.1}, {ms * 101.3}};
    ms *= 1.37;
    record.strategies.push_back(row);
  }
  return record;
}

// The given scenes in both pipelines.
inline std::vector<Record> wide_records(const std::vector<std::string>& scenes) {
  std::vector<Record> records;
  for (const std::string& scene : scenes)
    for (const Pipeline pipeline : {Pipeline::vectorised, Pipeline::published})
      records.push_back(wide_record(scene, pipeline));
  return records;
}

inline std::vector<ShapedTable> shaped_of(const std::vector<Record>& records, bool intervals = false) {
  return shaped_tables(filled_tables(records), records, intervals);
}

}  // namespace cscd::bench
