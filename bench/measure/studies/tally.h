#pragma once

#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <random>
#include <span>
#include <vector>

#include "bench/measure/studies/workload.h"
#include "core/elementary/certified/filtered_exact.h"
#include "core/elementary/exact/exact.h"
#include "core/elementary/question/elementary_test.h"

// How elementary tests do on a workload: wrong answers, errors in time, nanoseconds.
namespace cscd::bench {

// Where the time of a query is booked: proved apart by the certified filter or the relative boxes; apart, but
// not by those; in contact.
enum class Nearness { far, near, contact };
inline constexpr std::array<const char*, 3> kNearnessNames = {"far", "near", "contact"};

// The oracle's truth about a query.
struct Truth {
  std::optional<exact::TimeEnclosure> contact;
  Nearness nearness;
};
Truth truth_of(const Question& asked, Kind kind);

Answer ask(const ElementaryTest& test, const Question& asked, Kind kind);

// How far `filtered_exact` has to go; asks once more, so that counting costs the timed call nothing.
ExactStage stage_of(const Question& asked, Kind kind);

// The least distance of the features over the interval, less the distance at which they are asked, in extents
// of the query; sampled, so from above.
double least_distance(const Question& asked, Kind kind);

struct Tally {
  std::uint64_t queries = 0, contacts = 0;
  std::uint64_t false_negatives = 0, false_positives = 0;
  std::uint64_t undecided_contacts = 0, undecided_apart = 0;
  std::vector<double> false_positive_distances;  // of the first kDistances
  std::uint64_t times = 0;                       // contacts that were called so
  double largest_early = 0, largest_late = 0;
  std::array<std::uint64_t, 256> time_errors{};  // by size, see bin_of
  std::array<std::vector<double>, 3> ns;         // by nearness: a mean a block and pass
  std::array<std::uint64_t, 3> timed{};          // queries, each counted once
  std::vector<double> block_ns;  // each block and pass as a whole; all tests of a block have the same number

  void count(const Question& asked, Kind kind, const Truth& truth, const Answer& answer);
  void add(const Tally& other);
  bool breaks(const ElementaryTest& test) const;
  nlohmann::ordered_json json() const;
};

// Asks every test every query of a block, passes times over: the tests take turns in an order drawn anew, for
// each class of nearness by itself. Answers are those of the last pass.
void measure(std::span<const Question> questions, std::span<const Truth> truths, Kind kind,
             std::span<const ElementaryTest* const> tests, int passes, std::mt19937_64& random,
             std::span<Tally*> tallies);

}  // namespace cscd::bench
