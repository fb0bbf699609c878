#include "bench/strategies/strategy_row.h"

#include "bench/strategies/catalogue.h"
#include "core/base/error.h"

namespace cscd::bench {
namespace {

// With bones, preparation takes two to three and a half times as long. By the overlap tests that bones spare,
// they repay that after some 250 intervals of `urchin` and 1,600 of `hand`, and never on the other scenes.
// Preparation and queries both grow with the number of triangles, so the number of intervals alone decides.
constexpr std::size_t kIntervalsThatRepayBones = 1000;

}  // namespace

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
  if (!row.first) return verify(reference, answer, guarantee, starts_embedded);
  ContactSet earliest = reference;
  keep_first(earliest);
  const bool all = promises_all(guarantee, starts_embedded);
  const Verification in_time =
      verify(reference, answer, all ? Guarantee::first_contact : guarantee, all || starts_embedded);
  Verification of_earliest = verify(earliest, answer, guarantee, starts_embedded);
  if (!all || !in_time.ok) of_earliest.ok = in_time.ok, of_earliest.failure = in_time.failure;
  return of_earliest;
}

std::optional<std::string> why_not(const Strategy& strategy, const TriangleMesh& mesh, bool has_bones) {
  if (strategy.needs == Needs::closed_mesh_with_bones && !has_bones) return "needs bones, and there are none";
  if (strategy.needs == Needs::any_mesh) return std::nullopt;
  try {
    require_closed_and_oriented(mesh, "it");
  } catch (const InputError& error) {
    return error.what();
  }
  return std::nullopt;
}

bool gets_bones(const Strategy& strategy, std::size_t intervals) {
  return strategy.needs == Needs::closed_mesh_with_bones || intervals >= kIntervalsThatRepayBones;
}

StrategyInput setup_for(const Strategy& strategy, StrategyInput setup, std::size_t intervals) {
  if (!gets_bones(strategy, intervals)) setup.rig = nullptr;
  return setup;
}

}  // namespace cscd::bench
