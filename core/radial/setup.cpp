#include "core/radial/setup.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"

namespace cscd::radial {

void require_radial_setup(const Setup& setup, const std::string& strategy) {
  require_closed_and_oriented(setup.mesh, "strategy " + strategy);
  if (setup.rig == nullptr || setup.rig->parent.empty())
    throw InputError(
        "strategy " + strategy +
        " needs bones and the input has none; add /bones to the point cache or use a strategy that needs "
        "no rig, such as base");
}

int full_resolution(const TriangleMesh& mesh, std::span<const Vec3> reference) {
  constexpr int most = 256;
  Vec3 low = reference[0], high = low;
  for (const Vec3& x : reference) low = low.cwiseMin(x), high = high.cwiseMax(x);
  double sum = 0;
  for (const Edge& edge : mesh.edges()) sum += (reference[+edge[0]] - reference[+edge[1]]).norm();
  const double cells = (high - low).maxCoeff() * static_cast<double>(mesh.edge_count()) / sum;
  return cells < most ? std::max(8, static_cast<int>(std::ceil(cells))) : most;
}

}  // namespace cscd::radial
