#pragma once

#include <CLI/App.hpp>
#include <optional>
#include <string>

#include "bench/answer/answer.h"
#include "bench/answer/ignore.h"
#include "bench/answer/options/model_options.h"
#include "bench/inputs/thickness_request.h"
#include "bench/inputs/watchdog.h"

namespace cscd::bench {

// What the commands that answer the intervals of an input have in common.
struct AnswerRequest {
  std::string input, elementary = "filtered_exact", frames;
  AnswerOptions answers;
  IgnoreRequest ignored;
  ThicknessRequest thickness;
  std::optional<double> interval_seconds;
  std::optional<WrittenLength> resolution;  // with --true-motion
  int threads = 1;
  ModelOptions model;
};

// The input itself and these options. `request` must live as long as the command.
void add_answer_options(CLI::App& command, AnswerRequest& request);

// --ignore and --ignore-neighbours. `request` must live as long as the command.
void add_ignore_options(CLI::App& command, IgnoreRequest& request);

// --thickness, --exclude-rings and --exclude-near-rest. `request` must live as long as the command.
void add_thickness_options(CLI::App& command, ThicknessRequest& request);
// --thickness alone.
void add_thickness_option(CLI::App& command, ThicknessRequest& request);

// --resolution, of commands that take --true-motion. `request` must live as long as the command.
void add_resolution_option(CLI::App& command, AnswerRequest& request);

// Throws InputError where options do not go together.
void require_sound(const AnswerRequest& request);

// Ends the program if an interval takes longer than the request allows.
Watchdog watchdog_of(const AnswerRequest& request, const Input& input);

}  // namespace cscd::bench
