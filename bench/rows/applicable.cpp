#include "bench/rows/applicable.h"

#include "core/base/error.h"

namespace cscd::bench {
namespace {

// Preparation with bones takes some 40 ms longer for 11,000 triangles, where a query becomes 0.04 ms shorter
// at the best (`hand`). Both grow with the number of triangles.
constexpr std::size_t kIntervalsThatRepayBones = 1000;

}  // namespace

std::optional<std::string> why_not(const Strategy& strategy, const TriangleMesh& mesh, bool has_bones) {
  if (strategy.needs.bones && !has_bones) return "needs bones, and there are none";
  if (!strategy.needs.closed_mesh) return std::nullopt;
  try {
    require_closed_and_oriented(mesh, "it");
  } catch (const InputError& error) {
    return error.what();
  }
  return std::nullopt;
}

bool gets_bones(const Strategy& strategy, std::size_t intervals) {
  return strategy.needs.bones || intervals >= kIntervalsThatRepayBones;
}

Setup setup_for(const Strategy& strategy, Setup setup, std::size_t intervals) {
  if (!gets_bones(strategy, intervals)) setup.rig = nullptr;
  return setup;
}

}  // namespace cscd::bench
