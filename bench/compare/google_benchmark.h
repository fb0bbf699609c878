#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "bench/measure/record/record.h"

// The JSON files of other benchmark programs. Google Benchmark's can be read and written; the list of
// github-action-benchmark can be written.
namespace cscd::bench {

// Whether a document is what Google Benchmark writes with --benchmark_format=json.
bool is_google_benchmark(const nlohmann::ordered_json& document);

// Returns the measurements of such a document as a record: one row a benchmark with one stage, `traversal`,
// and no counters, digests or verification. The scene is the executable's name. Aggregates are passed over,
// as the comparison makes its own. Throws InputError, which `where` begins.
Record record_from_google_benchmark(const nlohmann::ordered_json& document, const std::string& where);

// Returns the times of records as such a document: one benchmark for each repetition of each stage of each
// row, named SCENE/ROW/STAGE, so that Google's compare.py can hold two documents against each other.
nlohmann::ordered_json google_benchmark_json(std::span<const Record> records);

// Returns the same figures as the list that github-action-benchmark reads with its tool
// `customSmallerIsBetter`: one entry a stage with the median over repetitions and half of its 95 % interval.
nlohmann::ordered_json github_action_json(std::span<const Record> records);

}  // namespace cscd::bench
