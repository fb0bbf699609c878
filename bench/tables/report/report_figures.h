#pragma once

#include <nlohmann/json.hpp>

// What the page of `cscd report` draws from the records of two studies.
namespace cscd::bench {

// Accuracy against time, from a record of `cscd accuracy`: for each group of workloads and each elementary
// test the numbers of queries, of contacts that it lost, of contacts that it invented, of those that it left
// undecided, and the mean time of a query in nanoseconds (null where nothing was timed).
nlohmann::json accuracy_points(const nlohmann::json& record);

// How cost grows, from a record of `cscd scale`: for each study, scene and strategy the milliseconds of a
// query at each size, and the exponent of the power law through them where one was fitted. A size is a number
// of triangles, of bones or of threads, or a length of step.
nlohmann::json growth_points(const nlohmann::json& record);

}  // namespace cscd::bench
