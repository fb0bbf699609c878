#pragma once

#include <cstddef>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bench/benchmark/benchmark.h"
#include "bench/benchmark/benchmark_answers.h"
#include "bench/records/shortfall.h"

namespace cscd::bench {

// What became of some answers. Every word is defined in bench/BENCHMARK.md.
struct Score {
  std::size_t intervals = 0;  // of the benchmark
  std::size_t answered = 0;
  std::size_t expected = 0;  // what could be missed: contacts, or one for each interval that touches
  std::size_t misses = 0, inventions = 0, undecided = 0;
  std::size_t broken = 0;  // answers that claim something and miss
  std::size_t timed = 0;   // contacts of the truth whose time was given
  std::size_t late = 0, early = 0;
  double latest = 0, earliest = 0;  // the largest errors of each kind, in intervals
  std::size_t starts_told = 0, starts_wrong = 0;
  std::size_t start_pairs_missed = 0, start_pairs_invented = 0;
  std::size_t collides_told = 0, collides_wrong = 0;
  // Of the truth, in intervals that were answered, and those of them that an answer lists.
  std::size_t contacts = 0, kept = 0;
  std::size_t unpromised = 0;        // answers that claim nothing, from a start that is not embedded
  std::vector<double> milliseconds;  // of the answers that give them

  void add(const Score& other);
  Shortfall shortfall() const { return {contacts, kept, answered, unpromised}; }
};

// A miss, an invention, a wrong time or a wrong word about a start, in a line for people.
struct Fault {
  std::string id, what;
};

struct Judgement {
  std::string program, version;
  std::string benchmark;  // the SHA-256 checksum of its manifest
  std::map<std::string, Score> families;
  std::vector<std::string> family_order;      // as the benchmark lists them
  std::map<std::string, std::string> set_of;  // of a family
  std::vector<std::string> set_order;
  std::vector<std::string> unanswered;  // ids
  std::vector<Fault> faults;            // the first thousand of them
  std::size_t fault_count = 0;          // of all
  nlohmann::ordered_json notes;         // the program's own

  Score set(const std::string& name) const;
  Score all() const;
};

// Judges answers. Times that are off by no more than `time_tolerance` are neither late nor early. Throws
// InputError for answers to intervals that the benchmark does not have, to another benchmark, or about
// vertices, edges and triangles that the mesh does not have; `where` begins its text.
Judgement judge(const Benchmark& benchmark, const Answers& answers, const std::string& where,
                double time_tolerance = 0);

// Judges the answer to one interval. `faults` gets a line for each fault.
Score judge_interval(const IntervalTruth& truth, const IntervalAnswers& answer, double time_tolerance,
                     std::vector<Fault>& faults);

nlohmann::ordered_json to_json(const Judgement& judgement);  // score.schema.json
// A table of sets for people, or of families.
std::string describe(const Judgement& judgement, bool by_family);

}  // namespace cscd::bench
