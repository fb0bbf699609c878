#pragma once

#include <string>

#include "bench/records/record.h"

namespace cscd::bench::test {

// A record of one process: a complete row, one that promises the first contact, and a heuristic one, on four
// counted intervals, two of them timed and verified. Intervals 1 and 2 have contacts.
inline Record small_record(const std::string& commit = "aaaaaaaaaaaaaaaa", int second = 0) {
  Record record;
  const std::string seconds = (second < 10 ? "0" : "") + std::to_string(second);
  record.environment = {{"date", "2026-11-25T12:00:" + seconds + "Z"},
                        {"commit", commit},
                        {"dirty", false},
                        {"cpu", "a machine"},
                        {"cores", 2},
                        {"instruction_set", "AVX-512"},
                        {"build_type", "Release"}};
  record.command = {"cscd", "run"};
  record.scene = {"hand", "A hand.", "00ff", 4, 8, 1, 5};
  record.elementary = "newton";
  record.intervals = 4;
  record.counted_intervals = {0, 1, 2, 3};
  record.timed_intervals = {0, 2};
  record.verification.reference = "slow";
  record.verification.elementary = "exact";
  record.verification.intervals = {0, 2};
  record.verification.colliding = {2};
  record.verification.strategies = {{"slow", "complete", 3, 3, 1, {}},
                                    {"swift", "first_contact", 3, 2, 1, {}},
                                    {"rough", "heuristic", 3, 2, 0, {}}};
  record.verification.accuracy = {1, 0, 0, 1e-9};
  record.verification.accuracy_tests = 100;
  StrategyRecord slow;
  slow.name = "slow";
  slow.guarantee = "complete";
  slow.counts = {{"bvot", {100, 200, 300, 400}}, {"contacts", {0, 2, 3, 0}}, {"clusters", {4, 4, 4, 4}}};
  slow.digests = {"e0", "c1", "c2", "e0"};
  slow.first_times = {std::nullopt, 0.25, 0.5, std::nullopt};
  slow.ms = {{"refit", {{1, 1}, {1, 1}}}, {"traversal", {{6, 12}, {7, 11}}}};
  slow.preparation.decomposition_ms = {4, 2};
  StrategyRecord swift = slow, rough = slow;
  swift.name = "swift";
  swift.guarantee = "first_contact";
  swift.digests = {"e0", "d1", "d2", "e0"};
  rough.name = "rough";
  rough.guarantee = "heuristic";
  record.strategies = {slow, swift, rough};
  return record;
}

}  // namespace cscd::bench::test
