#include "bench/rows/applicable.h"

#include "core/base/error.h"

namespace cscd::bench {

std::optional<std::string> why_not(const Strategy& strategy, const TriangleMesh& mesh, bool has_bones) {
  if (strategy.needs_rig && !has_bones) return "needs bones, and there are none";
  const bool any_surface = !strategy.needs_rig && strategy.guarantee != Guarantee::first_contact;
  if (any_surface) return std::nullopt;
  try {
    require_closed_and_oriented(mesh, "it");
  } catch (const InputError& error) {
    return error.what();
  }
  return std::nullopt;
}

}  // namespace cscd::bench
