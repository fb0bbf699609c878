#pragma once

#include <CLI/App.hpp>
#include <string>

namespace cscd::bench {

// One line that says what is wrong with a command line. A misspelt command or option is named before anything
// that is missing, since what is missing is often what was misspelt.
std::string usage_error(const CLI::App& program, const CLI::ParseError& error);

// Throws InputError for a word that is not UTF-8, because it could stand in no answer, all of which are JSON,
// and for a word with characters that control a terminal or the direction of writing, because answers for
// people repeat it.
void require_text(int count, const char* const* words);

}  // namespace cscd::bench
