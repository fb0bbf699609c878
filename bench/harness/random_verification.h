#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "bench/strategies/strategy_row.h"
#include "bench/strategies/verify.h"

namespace cscd::bench {

struct RandomVerification {
  std::size_t intervals = 1000;
  std::uint64_t first_seed = 1;
  // One interval in so many is judged by the test of all pairs, and the others by the complete reference,
  // which the test of all pairs verifies.
  std::size_t brute_every = 10;
  bool thick = false;  // every interval at a random thickness, by the rows that know distances
};

struct RandomFailure {
  std::uint64_t seed;
  bool torn;
  std::string family, strategy, what;
};

// What one strategy did on its intervals.
struct RandomRow {
  std::size_t intervals = 0;
  std::uint64_t contacts_expected = 0, contacts_found = 0;
  std::uint64_t triangle_pairs = 0, feature_pairs = 0;  // passed on
  // Over whole embedded starts with contacts: contacts of the earliest time that are not reported, and the
  // intervals that lack some. The guarantee first_contact allows all but one.
  std::size_t first_pairs_missing = 0, firsts_thinned = 0;
  std::size_t firsts_lost = 0;  // intervals among these that lack them all
  std::size_t invented = 0;     // reported by a strategy's own elementary test, and no contacts
};

struct RandomSummary {
  std::size_t intervals = 0, torn = 0, embedded = 0, with_contacts = 0, embedded_with_contacts = 0,
              contacts = 0;
  // The poses on which the test that decides starts was held to the plain one.
  std::size_t poses = 0, poses_crossing = 0, crossings = 0;
  std::map<std::string, RandomRow> rows;                // by the row's name
  std::map<std::string, std::size_t> embedded_hits_of;  // embedded starts with contacts, by family
  Accuracy newton;                                      // of the first elementary test, on the same pairs
  std::vector<RandomFailure> failures;
};

// Runs every row's strategy on random intervals, with exact answers for the pairs that it passes on, and
// holds it to its guarantee. `progress` gets the number of intervals done.
RandomSummary verify_random(const RandomVerification& plan, std::span<const StrategyRow> rows,
                            const std::function<void(std::size_t)>& progress = {});

std::string describe(const RandomSummary& summary);

// Writes the failing interval as a point cache; returns a line that says what failed, its seed and where it
// is.
std::string write_failure(const RandomFailure& failure, const std::filesystem::path& folder);

}  // namespace cscd::bench
