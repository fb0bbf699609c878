#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "bench/records/record.h"
#include "bench/records/shortfall.h"
#include "bench/statistics/statistics.h"

namespace cscd::bench {

// A figure out of a record, or the reason why it cannot be had.
struct Measured {
  std::optional<double> value;
  std::optional<Estimate> interval;  // 95 %; absent for what has no noise: counters and sizes
  std::string reason;                // empty when there is a value
  bool marked = false;               // a time that stands with kShortfallMark where it is printed
  std::string of = {};               // the row that kBestBaseline stands for
};

// Stands in a definition for the complete row that has the least figure. Rows of the fast engine and rows
// that are asked for the first contact alone are no baselines.
inline constexpr char kBestBaseline[] = "best baseline";

// What a definition (a column of table_definitions.json, a claim of claims.json) asks for:
//   quantity   scene.triangles, scene.vertices, scene.bones
//              preparation.distance_and_heat_ms, .decomposition_ms, .atomic_clusters
//              counts.A+B...      a statistic over all intervals of the sum of counters
//              ms.A+B...          a statistic over the timed intervals of the sum of stages, one for each
//                                 repetition; the stage `query` is a whole query with refit
//              ms.streaming       the same of streaming all positions once from memory
//              verification.recall, .first_contacts
//              footprint.peak_bytes, .held_bytes, .instructions
//              truth.contacts, .missed, .invented    of truth from outside
//   strategy   whose; absent for scene.* and truth.*; kBestBaseline
//   statistic  mean (default), median, min, max
//   scale      a factor, 1 by default
//   over       the strategy whose figure divides it; over_quantity, unless it is the same quantity
// Throws std::logic_error for a definition that says something else.
Measured measure(const nlohmann::ordered_json& definition, const Record& record);

// What the median interval takes a strategy, with refit, in milliseconds; or how many times as long as
// `over`.
Measured median_query(const std::string& strategy, const Record& record, const std::string& over = "");

// The same quantity of two records, the first divided by the second. The two were not measured in turns, so
// there is no interval.
Measured measure_over(const nlohmann::ordered_json& definition, const Record& record, const Record& divisor);

// "16.6 [16.5, 16.9]*, `mcd`": the figure, its interval where that is asked for, its mark, and the row that
// kBestBaseline stands for. Empty where there is no figure.
std::string text_of(const Measured& figure, bool with_interval);

}  // namespace cscd::bench
