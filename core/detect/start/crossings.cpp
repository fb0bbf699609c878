#include "core/detect/start/crossings.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <set>
#include <utility>

#include "core/base/sort_unique.h"
#include "core/elementary/exact/static_contact.h"

namespace cscd {
namespace {

std::span<const TriangleId> triangles_with_first(const TriangleMesh& mesh, const FeaturePair& pair) {
  if (pair.kind == FeaturePair::Kind::vertex_face) return mesh.triangles_at(VertexId{pair.a});
  return mesh.triangles_at(EdgeId{pair.a});
}

using ComponentPair = std::pair<std::int32_t, std::int32_t>;

ComponentPair components_of(const TriangleMesh& mesh, const CrossingPair& pair) {
  return std::minmax(mesh.component(pair.first), mesh.component(pair.second));
}

// The pairs of components of which one is a copy of the other, or of a part of it, in the same place.
std::set<ComponentPair> copied_components(const TriangleMesh& mesh, std::span<const Vec3> positions,
                                          const Crossings& met) {
  const auto places = [&](TriangleId t) {
    std::array<std::array<double, 3>, 3> out;
    for (std::size_t k = 0; k < 3; ++k) std::ranges::copy(positions[+mesh.corners(t)[k]], out[k].begin());
    std::ranges::sort(out);
    return out;
  };
  std::map<ComponentPair, std::array<std::vector<TriangleId>, 2>> twins;  // of the first and of the second
  for (const CrossingPair& pair : met.pairs) {
    const ComponentPair both = components_of(mesh, pair);
    if (both.first == both.second || places(pair.first) != places(pair.second)) continue;
    const bool is_first = mesh.component(pair.first) == both.first;
    twins[both][0].push_back(is_first ? pair.first : pair.second);
    twins[both][1].push_back(is_first ? pair.second : pair.first);
  }
  if (twins.empty()) return {};
  std::map<std::int32_t, std::size_t> size;  // of components, in triangles
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t)
    ++size[mesh.component(TriangleId{static_cast<std::int32_t>(t)})];
  std::set<ComponentPair> copies;
  for (auto& [both, sides] : twins) {
    for (std::vector<TriangleId>& side : sides) sort_unique(side);
    if (sides[0].size() == size.at(both.first) || sides[1].size() == size.at(both.second))
      copies.insert(both);
  }
  return copies;
}

// [components]: whether each is closed and consistently oriented, so that it has an inside.
std::vector<bool> components_with_inside(const TriangleMesh& mesh) {
  std::vector<bool> out(static_cast<std::size_t>(mesh.component_count()), true);
  if (mesh.closed_and_oriented()) return out;
  for (std::size_t e = 0; e < mesh.edge_count(); ++e) {
    const EdgeId edge{static_cast<std::int32_t>(e)};
    const std::span<const TriangleId> at = mesh.triangles_at(edge);
    const auto along = [&](TriangleId t) {  // how often the triangle runs along the edge in its direction
      int count = 0;
      for (std::size_t i = 0; i < 3; ++i)
        count +=
            mesh.corners(t)[i] == mesh.ends(edge)[0] && mesh.corners(t)[(i + 1) % 3] == mesh.ends(edge)[1];
      return count;
    };
    if (at.size() != 2 || along(at[0]) == along(at[1]))
      out[static_cast<std::size_t>(mesh.component(at.front()))] = false;
  }
  return out;
}

}  // namespace

std::vector<CrossingPair> carriers(const TriangleMesh& mesh, const FeaturePair& pair) {
  const TriangleId face{pair.b};
  const std::span<const TriangleId> others =
      pair.kind == FeaturePair::Kind::vertex_face ? std::span(&face, 1) : mesh.triangles_at(EdgeId{pair.b});
  std::vector<CrossingPair> out;
  for (const TriangleId s : triangles_with_first(mesh, pair))
    for (const TriangleId t : others)
      if (s != t) out.emplace_back(std::min(s, t), std::max(s, t));
  return out;
}

Meetings tell_meetings_apart(const TriangleMesh& mesh, std::span<const Vec3> positions,
                             const Crossings& met) {
  const std::set<ComponentPair> copies = copied_components(mesh, positions, met);
  std::vector<bool> has_inside;  // [components]
  const auto shares_inside = [&](const CrossingPair& pair) {
    if (lie_on_each_other(mesh, positions, pair.first, pair.second) != 1) return false;
    if (has_inside.empty()) has_inside = components_with_inside(mesh);
    const ComponentPair both = components_of(mesh, pair);
    return has_inside[static_cast<std::size_t>(both.first)] &&
           has_inside[static_cast<std::size_t>(both.second)];
  };
  Meetings out;
  for (const CrossingPair& pair : met.pairs) {
    const bool crosses = triangles_cross(mesh, positions, pair.first, pair.second) || shares_inside(pair) ||
                         copies.contains(components_of(mesh, pair));
    (crosses ? out.crossing : out.touching).pairs.push_back(pair);
  }
  out.crossing.total = out.crossing.pairs.size();
  out.touching.total = out.touching.pairs.size();
  return out;
}

}  // namespace cscd
