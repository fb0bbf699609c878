#include "core/radial/smoothing.h"

#include <algorithm>
#include <cstddef>

namespace cscd::radial {

std::vector<Vec3> smoothed(const TriangleMesh& mesh, std::span<const Vec3> positions, int passes) {
  std::vector<Vec3> current(positions.begin(), positions.end());
  std::vector<int> neighbours(current.size(), 0);
  for (const Edge& e : mesh.edges()) {
    ++neighbours[+e[0]];
    ++neighbours[+e[1]];
  }
  std::vector<Vec3> sum(current.size());
  for (int pass = 0; pass < passes; ++pass) {
    std::fill(sum.begin(), sum.end(), Vec3::Zero());
    for (const Edge& e : mesh.edges()) {
      sum[+e[0]] += current[+e[1]];
      sum[+e[1]] += current[+e[0]];
    }
    for (std::size_t v = 0; v < current.size(); ++v)
      if (neighbours[v] > 0) current[v] = (current[v] + sum[v] / neighbours[v]) / 2;
  }
  return current;
}

}  // namespace cscd::radial
