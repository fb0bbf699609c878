#include "core/detect/start/rest_crossings.h"

#include <algorithm>

#include "core/base/sort_unique.h"

namespace cscd {
namespace {

// Returns all triangles within some rings round one triangle, that triangle included.
std::vector<TriangleId> within_rings(const TriangleMesh& mesh, TriangleId center, int rings) {
  std::vector<TriangleId> inside{center};
  for (int ring = 0; ring < rings; ++ring) {
    const std::size_t end = inside.size();
    for (std::size_t i = 0; i < end; ++i)
      for (const VertexId vertex : mesh.corners(inside[i]))
        for (const TriangleId next : mesh.triangles_at(vertex)) inside.push_back(next);
    sort_unique(inside);
  }
  return inside;
}

}  // namespace

RestCrossings::RestCrossings(const TriangleMesh& mesh, const Crossings& at_rest)
    : mesh_(&mesh), pairs_(at_rest) {
  std::vector<std::pair<TriangleId, std::uint32_t>> entries;
  for (std::size_t i = 0; i < pairs_.pairs.size(); ++i) {
    const auto [first, second] = pairs_.pairs[i];
    if (mesh.component(first) == mesh.component(second)) continue;
    const auto number = static_cast<std::uint32_t>(2 * i);
    for (const TriangleId t : within_rings(mesh, first, kRings)) entries.emplace_back(t, number);
    for (const TriangleId t : within_rings(mesh, second, kRings)) entries.emplace_back(t, number + 1);
  }
  std::sort(entries.begin(), entries.end());
  offset_.assign(mesh.triangle_count() + 1, 0);
  for (const auto& [triangle, number] : entries) {
    ++offset_[+triangle + 1];
    near_.push_back(number);
  }
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) offset_[t + 1] += offset_[t];
}

std::span<const std::uint32_t> RestCrossings::near(TriangleId triangle) const {
  return std::span(near_).subspan(offset_[+triangle], offset_[+triangle + 1] - offset_[+triangle]);
}

bool RestCrossings::explains(const CrossingPair& pair) const {
  if (empty()) return false;
  if (pairs_.contains(pair)) return true;
  // The pair is explained if one triangle is near the first triangle of a crossing and the other is near its
  // second. The numbers of these two entries differ in the last bit.
  const std::span<const std::uint32_t> others = near(pair.second);
  return std::ranges::any_of(
      near(pair.first), [&](std::uint32_t number) { return std::ranges::binary_search(others, number ^ 1); });
}

bool RestCrossings::explains(const FeaturePair& pair) const {
  if (empty()) return false;
  return std::ranges::any_of(carriers(*mesh_, pair), [&](const CrossingPair& p) { return explains(p); });
}

}  // namespace cscd
