#include "bench/strategy_row.h"

#include "bench/catalogue.h"
#include "core/base/error.h"
#include "core/detect/first_only.h"

namespace cscd::bench {

std::vector<StrategyRow> rows_of(std::span<const Strategy> strategies) {
  std::vector<StrategyRow> rows;
  for (const Strategy& strategy : strategies) rows.push_back({&strategy});
  return rows;
}

std::vector<StrategyRow> rows_called(std::span<const std::string> texts) {
  std::vector<StrategyRow> rows;
  for (std::string_view name : texts) {
    const bool first = name.ends_with(StrategyRow::kFirst);
    if (first) name.remove_suffix(StrategyRow::kFirst.size());
    for (const Strategy* strategy : strategies_called(name)) {
      if (first && strategy->own_test)
        throw InputError("--strategy " + std::string(name) + " --first: " + std::string(strategy->name) +
                         " tests pairs by itself and finds all; leave --first out");
      rows.push_back({strategy, first});
    }
  }
  return rows;
}

Verification verify(const ContactSet& reference, const ContactSet& answer, const StrategyRow& row,
                    bool starts_embedded) {
  if (!row.first) return cscd::verify(reference, answer, row.strategy->guarantee, starts_embedded);
  ContactSet earliest = reference;
  keep_first(earliest);
  return cscd::verify(earliest, answer, row.strategy->guarantee, starts_embedded);
}

}  // namespace cscd::bench
