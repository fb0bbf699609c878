#pragma once

#include <nlohmann/json.hpp>

// What pages say of the records of studies: `cscd accuracy` and `cscd scale`.
namespace cscd::bench {

// Sums over workloads, by what the workloads have in common and then by elementary test: "group hard",
// "hardness 0.001", "family cone" (of the hard suite), "sweep" (hard suite and open set) and "all". A sum has
// the numbers of queries, of contacts, of contacts lost and invented, of answers left undecided; the mean
// nanoseconds of a query over all of them, the near misses and the contacts (a key is missing where nothing
// was timed); and the largest of the errors that its workloads have. `stages` has the numbers of queries that
// `filtered_exact` answered in each of its stages, by "group hard" and by "hard cone".
nlohmann::json accuracy_json(const nlohmann::json& record);

// For each study, scene and strategy the milliseconds of a query at each size, and the exponent of the power
// law through them where one was fitted. A size is a number of triangles, of bones or of threads, a length of
// step or a thickness. `shortfalls` says what the rows of each step of each subject lack (shortfall.h), by
// name.
nlohmann::json growth_json(const nlohmann::json& record);

}  // namespace cscd::bench
