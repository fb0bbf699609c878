#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bench/benchmark/pair_name.h"
#include "core/detect/detector.h"

// The answers of any program to the intervals of a benchmark (bench/BENCHMARK.md, answers.schema.json).
namespace cscd::bench {

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
