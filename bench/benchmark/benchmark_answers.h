#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/detect/contact.h"
#include "core/detect/detector.h"
#include "core/mesh/triangle_mesh.h"

// The answers of any program to the intervals of a benchmark (bench/BENCHMARK.md, answers.schema.json).
namespace cscd::bench {

// A feature pair in numbers that every program has: vertices and triangles by their row in the arrays of the
// mesh, and edges by the vertices at their ends.
struct PairName {
  FeaturePair::Kind kind = FeaturePair::Kind::vertex_face;
  // The vertex and the triangle, then -1 twice; or the ends of one edge and the ends of the other. In the
  // canonical order the smaller end of an edge comes first, and so does the edge with the smaller first end
  // (and, of two edges with the same first end, the one with the smaller second end).
  std::array<std::int32_t, 4> index = {-1, -1, -1, -1};

  static PairName of(const TriangleMesh& mesh, const FeaturePair& pair);
  static PairName vertex_face(std::int32_t vertex, std::int32_t triangle);
  static PairName edge_edge(std::int32_t a0, std::int32_t a1, std::int32_t b0, std::int32_t b1);  // any order

  auto operator<=>(const PairName&) const = default;
};

// "vf" or "ee": the key of a pair in JSON, whose value is the list of its numbers.
const char* key_of(const PairName& pair);
nlohmann::ordered_json numbers_json(const PairName& pair);
// "vertex 5, triangle 17" or "edges 3-8 and 12-15".
std::string text(const PairName& pair);

inline constexpr char kAnswersSchema[] = "cscd.answers/1";

// What a program claims of an answer, and so by what the answer is judged.
enum class Claim {
  complete,       // every feature pair that touches is there
  first_contact,  // a feature pair that touches first is there, or its time alone
  collides,       // yes or no
  none            // judged as `complete`, but nothing is promised
};
std::string_view to_string(Claim claim);

struct AnsweredContact {
  PairName pair;
  std::optional<double> time;  // in [0, 1]; none for a pair that the program could not decide
};

struct IntervalAnswers {
  std::string id;
  Claim claim = Claim::complete;
  std::optional<std::vector<AnsweredContact>> contacts;
  // The first contact's time alone: outer none: not told; inner none: nothing touches.
  std::optional<std::optional<double>> first_time;
  std::optional<bool> collides, starts_embedded;
  std::optional<std::vector<CrossingPair>> start_pairs;  // the smaller triangle first
  std::optional<double> milliseconds;
};

struct Answers {
  std::string program, version;
  std::optional<std::string> benchmark;  // the SHA-256 checksum of the manifest that was answered
  nlohmann::ordered_json notes;          // whatever the program says of itself; null where it says nothing
  std::vector<IntervalAnswers> intervals;
};

// Reads one JSON document, or JSON lines, of which the first is the head and each other one an answer; either
// may be compressed with gzip. Throws InputError, which says what is wrong, in which answer, and how to mend
// it, for anything that does not keep to the format: unknown keys, numbers out of range, and intervals or
// pairs that are there twice.
Answers read_answers(const std::filesystem::path& path);
Answers parse_answers(const std::string& text, const std::string& where);

nlohmann::ordered_json to_json(const Answers& answers);

}  // namespace cscd::bench
