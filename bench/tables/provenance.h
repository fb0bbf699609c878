#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "bench/records/record.h"

// Where and how records were measured, in words.
namespace cscd::bench {

// "AMD EPYC, 2 cores; GNU 12.2.0, Release, AVX-512; commit bd3b9e226539; 2026-11-25", once for each
// environment that differs in any of these.
std::vector<std::string> environments(std::span<const Record> records);
// "one thread", or which strategies shared their work among how many.
std::string threads_text(const Record& record);
// How many of the timed intervals are among the given ones, which ascend.
std::size_t timed_among(const std::vector<std::size_t>& intervals, const Record& record);

// How each record was measured and verified, in Markdown: sentences and a table of one row a record.
std::string how_measured(std::span<const Record> records);

}  // namespace cscd::bench
