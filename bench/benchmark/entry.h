#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "bench/benchmark/benchmark.h"
#include "bench/benchmark/benchmark_answers.h"
#include "bench/strategies/strategy_row.h"

namespace cscd::bench {

// The answers of a strategy to a benchmark, and why it left intervals out: reason to number of intervals.
struct Entry {
  Answers answers;
  std::map<std::string, std::size_t> left_out;
  std::vector<std::string> failures;  // intervals on which the strategy broke its promise, and how
};

// Asks a strategy about all intervals of a benchmark. What the strategy promises becomes the claim: nothing
// where it promises the first contact of an embedded start and the start is not embedded. An interval that
// the strategy cannot take is left out. Each interval is verified as `cscd run` verifies it, with
// `filtered_exact`, and then timed `repetitions` times. `milliseconds` is the median of what these took,
// without preparation; an answer that failed has none. `progress` gets the number of intervals done.
Entry answer_benchmark(const Benchmark& benchmark, const StrategyRow& row, const ElementaryTest& elementary,
                       std::size_t repetitions, const std::function<void(std::size_t)>& progress);

}  // namespace cscd::bench
