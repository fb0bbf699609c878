#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>

#include "bench/answer/clip_answer.h"
#include "bench/output/json_stream.h"

// Answers as JSON. Every field is described in query.schema.json.
namespace cscd::bench {

inline constexpr char kQuerySchema[] = "cscd.query/4";

// Writes all of an answer, interval by interval, so that a document is not limited by memory.
class ClipJson {
 public:
  // Begins the document of an answer of which no interval is known yet. `input` is the input as it was given,
  // and up to `most_start_pairs` of the pairs that cross in a pose are listed. `out` must outlive the object.
  ClipJson(JsonStream& out, const ClipAnswer& answer, const std::string& input, std::size_t most_start_pairs);

  void add(const ClipAnswer& answer, const IntervalAnswer& interval, const Motion& motion);
  // Ends the document: `answer` now holds the sums.
  void finish(const ClipAnswer& answer);

 private:
  JsonStream& out_;
  std::size_t most_start_pairs_;
};

// Writes members of the object that has begun. All of one object come in the order of their names.
void write_members(JsonStream& out, const nlohmann::json& members);

// The event of which the verdict speaks first; null for none.
nlohmann::json headline_json(const ClipAnswer& answer);

// The sums alone.
nlohmann::json summary_json(const ClipAnswer& answer);

// Lists the triangles that cross at rest by the parts of the surface that they belong to.
nlohmann::json rest_json(const ClipAnswer& answer);

}  // namespace cscd::bench
