#pragma once

#include <CLI/App.hpp>
#include <string>

#include "bench/answer/answer_request.h"

namespace cscd::bench {

// The input, and all options of a command that answers its intervals. `request` must live as long as the
// command.
void add_answer_options(CLI::App& command, AnswerRequest& request, bool several_strategies = false);

// Returns one of these options that was given, and that only answers go by; empty for none. --frames, and how
// a model file is read, matter to frames too.
std::string given_answer_option(const CLI::App& command);

}  // namespace cscd::bench
