#pragma once

#include <span>
#include <string>
#include <vector>

#include "bench/records/record.h"

// What two programs counted: work, which is exact, and memory and instructions, which nearly are.
namespace cscd::bench {

enum class Change { same, better, worse, different };

struct CounterFinding {
  std::string scene, row, counter;
  std::uint64_t before = 0, after = 0;  // sums over the counted intervals that both have
  std::size_t intervals = 0, intervals_that_differ = 0;
  Change change = Change::same;
};

struct FootprintFinding {
  std::string scene, row, what;  // peak_bytes, held_bytes or instructions
  double before = 0, after = 0;  // medians over the processes
  Change change = Change::same;
};

// Returns the counters that differ on any interval that both records counted. More of a cost
// (comparison.json) is worse, less of it better; other counters are merely different. Leaves out rows with
// other settings of their own (rows_of_other_settings).
std::vector<CounterFinding> compare_counters(const Record& before, const Record& after);

// How many counters of how many intervals were compared to find these.
std::size_t compared_counts(const Record& before, const Record& after);

// Names the rows whose counters are not compared because the row itself was measured with other settings, and
// says in which.
std::vector<std::string> rows_of_other_settings(const Record& before, const Record& after);

// Why the counters of two records cannot be compared; empty where they can. Counters are compared between
// equal settings only (bench/compare/settings.h), since a setting changes them by intent.
std::string counters_refused(const Record& before, const Record& after);

// Returns the footprints that differ by more than the floors of comparison.json.
std::vector<FootprintFinding> compare_footprints(std::span<const Record> before,
                                                 std::span<const Record> after);

std::string_view to_string(Change change);

}  // namespace cscd::bench
