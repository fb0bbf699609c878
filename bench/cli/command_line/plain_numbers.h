#pragma once

#include <CLI/App.hpp>

namespace cscd::bench {

// Has every option that takes a number, of the program and of all its commands, refuse a text that is no
// plain finite number in the range of its type. CLI11 alone takes "nan", which no comparison with a range
// refuses, and makes the largest number of one that is too large.
void require_plain_numbers(CLI::App& program);

}  // namespace cscd::bench
