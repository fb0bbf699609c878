#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>

#include "bench/query/answer/clip_answer.h"

// Answers as JSON. Every field is described in query.schema.json.
namespace cscd::bench {

// All of an answer. Reads the clip once more, for where contacts lie. Up to `most_start_pairs` of the pairs
// that cross at the start of an interval are listed.
nlohmann::json clip_json(const ClipAnswer& answer, std::size_t most_start_pairs);

// The sums alone.
nlohmann::json summary_json(const ClipAnswer& answer);

// Lists the triangles that cross at rest by the parts of the surface that they belong to.
nlohmann::json rest_json(const ClipAnswer& answer);

}  // namespace cscd::bench
