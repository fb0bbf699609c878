#include "bench/measure/strategies/strategy_row.h"

#include "bench/measure/strategies/catalogue.h"
#include "core/base/error.h"

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
  const Guarantee guarantee = row.strategy->guarantee;
  if (!row.first || !promises_all(guarantee, starts_embedded))
    return cscd::verify(reference, answer, guarantee, starts_embedded);
  const Verification in_time = cscd::verify(reference, answer, Guarantee::first_contact, true);
  if (!in_time.ok) return in_time;
  ContactSet earliest = reference;
  keep_first(earliest);
  return cscd::verify(earliest, answer, guarantee, starts_embedded);
}

}  // namespace cscd::bench
