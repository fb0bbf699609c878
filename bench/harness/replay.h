#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "bench/command_line/option_rows.h"
#include "bench/harness/measurement.h"
#include "bench/inputs/input.h"
#include "bench/records/record.h"

// One measurement as a value, and its execution: a run of the whole input and each part of a divided run are
// executed by the same code.
namespace cscd::bench {

inline constexpr char kPublishedTest[] = "newton";  // the paper's elementary test

// What a user asks of a run.
struct ReplayRequest {
  std::string scene = "rope", elementary = kPublishedTest, pipeline = "today", frames;
  std::vector<std::string> strategies;  // names and groups; empty for all rows without a group
  std::size_t repetitions = 5, count_every = 1, time_every = 1, time_contacts = 3, verify_every = 1,
              seed = 2014;
  int threads = 1;
  bool smoke = false;
  // Only what every machine repeats to the bit: verdicts, counters and digests.
  bool counts = false;
  ModelOptions model;
};

// The options that a record echoes, but for the input and what belongs to it.
std::span<const OptionRow<ReplayRequest>> replay_options();

// Throws InputError where names are not known or do not go together. It opens nothing.
void require_sound(const ReplayRequest& request);

// A request that has been resolved for one input: its strategies are rows without groups, and it says in
// numbers what `smoke` stands for.
struct Replay {
  ReplayRequest request;
  std::vector<std::string> command;  // the command line of the whole run, with every default spelt out
  IntervalRange range;               // that the command spans
  Section section;  // the intervals of the range that are measured; all that are timed are verified
};

// Throws InputError where the input has no such frames, or allows none of the strategies.
Replay resolve(Input& input, const ReplayRequest& request);
// Verifies, counts and, unless `counts` alone are asked for, times. The record has no counters and no times
// if a strategy breaks its promise. A record of counts alone holds nothing that another run of the same
// program on the same input would not repeat.
Record execute(Input& input, const Replay& replay);

}  // namespace cscd::bench
