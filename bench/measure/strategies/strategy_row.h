#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/pipeline.h"
#include "core/detect/strategy.h"
#include "core/detect/verify.h"

namespace cscd::bench {

// A strategy, what it is asked for (by `first`, the earliest contact alone), and in which pipeline.
struct StrategyRow {
  static constexpr std::string_view kFirst = " --first";

  const Strategy* strategy;
  bool first = false;
  Pipeline pipeline = Pipeline::vectorised;

  std::string name() const { return std::string(strategy->name) + std::string(first ? kFirst : ""); }
  bool operator==(const StrategyRow&) const = default;
};

// Each asked for all contacts. They point into `strategies`.
std::vector<StrategyRow> rows_of(std::span<const Strategy> strategies);

// Returns the rows that texts such as NAME or "NAME --first" mean, where NAME is a strategy or a group of
// strategies. Throws InputError where NAME is not known, or where a strategy that brings its own elementary
// test is asked for the earliest contact alone.
std::vector<StrategyRow> rows_called(std::span<const std::string> texts);

// Holds an answer to the row's guarantee, as verify does for all contacts. What was asked for `first`, and
// cut down by `keep_first`, has to have all contacts of the earliest time where all are promised. Both sets
// sorted.
Verification verify(const ContactSet& reference, const ContactSet& answer, const StrategyRow& row,
                    bool starts_embedded);

}  // namespace cscd::bench
