#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bench/strategies/verify.h"
#include "core/base/pipeline.h"
#include "core/detect/strategy.h"

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
// cut down by `keep_first`, has to have all contacts of the earliest time where all are promised, and
// contacts are counted among those of the earliest time alone. Both sets sorted.
Verification verify(const ContactSet& reference, const ContactSet& answer, const StrategyRow& row,
                    bool starts_embedded);

// Says why a strategy cannot be made for a mesh (Strategy::needs); nothing where it can.
std::optional<std::string> why_not(const Strategy& strategy, const TriangleMesh& mesh, bool has_bones);

// Says whether a strategy gets the bones of a clip: always if it needs them. A strategy that can do without
// spares some work in every interval by them, and takes longer to prepare, so it gets them only for a clip of
// many intervals. Whether it is a query or a measurement makes no difference.
bool gets_bones(const Strategy& strategy, std::size_t intervals);
// Returns the set-up of a clip as the strategy gets it: without the rig if the strategy does not get bones.
StrategyInput setup_for(const Strategy& strategy, StrategyInput setup, std::size_t intervals);

}  // namespace cscd::bench
