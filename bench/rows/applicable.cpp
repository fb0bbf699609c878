#include "bench/rows/applicable.h"

#include "core/base/error.h"

namespace cscd::bench {

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

}  // namespace cscd::bench
