#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "bench/measure/record/record.h"

// Google Benchmark's files, which `cscd compare` reads as it reads records.
namespace cscd::bench {

// Whether a document is what Google Benchmark writes with --benchmark_format=json.
bool is_google_benchmark(const nlohmann::ordered_json& document);

// Returns the measurements of such a document as a record: one row a benchmark with one stage, `traversal`,
// and no counters, digests or verification. The scene is the executable's name. Aggregates are passed over,
// as the comparison makes its own. Throws InputError, which `where` begins.
Record record_from_google_benchmark(const nlohmann::ordered_json& document, const std::string& where);

}  // namespace cscd::bench
