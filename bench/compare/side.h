#pragma once

#include <algorithm>
#include <cstddef>
#include <map>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "bench/records/record.h"

namespace cscd::bench {

// One of the two programs that are compared: its records, a process each, by scene and in order of their
// dates.
struct Side {
  std::string commit;    // "unknown" where the records do not say
  bool dirty = false;    // whether the sources differed from that commit
  std::string measured;  // the date of the first record
  std::map<std::string, std::vector<Record>> scenes;
};

// Reads what the user named: a record, a folder of records, or several of both with commas between. In a
// folder, other JSON files are passed over. A file of Google Benchmark counts as a record without truth.
// Throws InputError where nothing is there to read, where the records are of several commits, and where two
// records of a scene have other settings.
Side read_side(const std::string& named);

// The same of records that are there.
Side side_of(std::vector<Record> records, const std::string& named);

// What an environment says under a key, as text; "unknown" where it says nothing.
std::string environment_text(const nlohmann::ordered_json& environment, const char* key);
inline std::string environment_text(const Record& record, const char* key) {
  return environment_text(record.environment, key);
}

// Which of several links of the same objects a record was measured with (scripts/compare-commits); "0" where
// the record does not say.
std::string layout_of(const Record& record);

// An interval that two records have, and its place in the list of each.
struct SharedInterval {
  std::size_t interval, before, after;
};

// Returns the intervals that two ascending lists share, in order.
inline std::vector<SharedInterval> shared_intervals(std::span<const std::size_t> before,
                                                    std::span<const std::size_t> after) {
  std::vector<SharedInterval> shared;
  for (std::size_t a = 0, b = 0; a < before.size() && b < after.size();) {
    const std::size_t least = std::min(before[a], after[b]);
    if (before[a] == after[b]) shared.push_back({least, a, b});
    a += before[a] == least;
    b += after[b] == least;
  }
  return shared;
}

// Google Benchmark's files are read as records are.
//
// Whether a document is what Google Benchmark writes with --benchmark_format=json.
bool is_google_benchmark(const nlohmann::ordered_json& document);

// Returns the measurements of such a document as a record: one row a benchmark with one stage, `traversal`,
// and no counters, digests or verification. The scene is the executable's name. Aggregates are passed over,
// as the comparison makes its own. Throws InputError, which `where` begins.
Record record_from_google_benchmark(const nlohmann::ordered_json& document, const std::string& where);

}  // namespace cscd::bench
