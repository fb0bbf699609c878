#include "bench/measure/strategies/applicable.h"

#include "core/base/error.h"

namespace cscd::bench {
namespace {

// With bones, preparation takes two to three and a half times as long. By the overlap tests that bones spare,
// they repay that after some 250 intervals of `urchin` and 1,600 of `hand`, and never on the other scenes.
// Preparation and queries both grow with the number of triangles, so the number of intervals alone decides.
constexpr std::size_t kIntervalsThatRepayBones = 1000;

}  // namespace

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
