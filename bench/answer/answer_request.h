#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bench/answer/answer.h"
#include "bench/inputs/input.h"

namespace CLI {
class App;
}

namespace cscd::bench {

// What a command that answers the intervals of an input is asked.
struct AnswerRequest {
  std::string input, elementary = "filtered_exact", frames;
  std::vector<std::string> strategies;  // by name; none for the best that the input allows
  AnswerOptions answers;
  bool new_contacts = false;  // what lies within events when an interval starts is left out
  IgnoreRequest ignored;
  ThicknessRequest thickness;
  std::optional<double> interval_seconds;
  WrittenLength resolution;  // with --true-motion
  std::string preparation;   // the file in which it is kept; empty for none
  int threads = 1;
  ModelOptions model;
};

// Throws InputError where what is asked does not go together.
void require_sound(const AnswerRequest& request);

// The input, and all options of a command that answers its intervals. `request` must live as long as the
// command.
void add_answer_options(CLI::App& command, AnswerRequest& request, bool several_strategies = false);

// Returns one of these options that was given, and that only answers go by; empty for none. --frames, and how
// a model file is read, matter to frames too.
std::string given_answer_option(const CLI::App& command);

}  // namespace cscd::bench
