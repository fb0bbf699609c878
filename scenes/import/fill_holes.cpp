#include "scenes/import/fill_holes.h"

#include <algorithm>
#include <unordered_map>

#include "scenes/polygon/triangulated_loop.h"

namespace cscd::scenes {
namespace {

using Loop = std::vector<VertexId>;

// The loops of boundary edges, each in the direction in which the missing triangles would run along it.
// Where two holes share a vertex, the way on is ambiguous; such loops are left out and counted as unclear.
struct Boundary {
  std::vector<Loop> loops;
  std::size_t unclear = 0;
};

Boundary boundary_of(const TriangleMesh& mesh) {
  std::unordered_map<std::int32_t, VertexId> next;
  std::unordered_map<std::int32_t, int> leaving;
  for (std::size_t e = 0; e < mesh.edge_count(); ++e) {
    const EdgeId edge{static_cast<std::int32_t>(e)};
    if (mesh.triangles_at(edge).size() != 1) continue;
    const TriangleId t = mesh.triangles_at(edge).front();
    for (std::size_t k = 0; k < 3; ++k) {
      if (mesh.edges_of(t)[k] != edge) continue;
      const VertexId from = mesh.corners(t)[(k + 1) % 3], to = mesh.corners(t)[k];
      next[static_cast<std::int32_t>(from)] = to;
      ++leaving[static_cast<std::int32_t>(from)];
    }
  }
  Boundary boundary;
  std::vector<std::int32_t> starts;
  for (const auto& [from, count] : leaving) starts.push_back(from);
  std::sort(starts.begin(), starts.end());
  std::vector<bool> seen(mesh.vertex_count(), false);
  for (const std::int32_t start : starts) {
    if (seen[static_cast<std::size_t>(start)]) continue;
    Loop loop;
    bool clear = true;
    VertexId v{start};
    while (!seen[+v]) {
      seen[+v] = true;
      loop.push_back(v);
      const auto out = next.find(static_cast<std::int32_t>(v));
      clear = clear && out != next.end() && leaving[static_cast<std::int32_t>(v)] == 1;
      if (!clear) break;
      v = out->second;
    }
    if (clear && v == VertexId{start} && loop.size() >= 3)
      boundary.loops.push_back(std::move(loop));
    else
      ++boundary.unclear;
  }
  return boundary;
}

}  // namespace

FilledHoles fill_holes(const TriangleMesh& mesh, std::span<const Vec3> positions, std::size_t most_edges) {
  const Boundary boundary = boundary_of(mesh);
  FilledHoles filled;
  filled.left = boundary.unclear;
  for (const Loop& loop : boundary.loops) {
    if (loop.size() > most_edges) {
      ++filled.left;
      continue;
    }
    std::vector<Vec3> points;
    for (const VertexId v : loop) points.push_back(positions[+v]);
    const auto patch = triangulated_loop(points, LoopKind::hole);
    if (patch.empty()) {
      ++filled.left;
      continue;
    }
    for (const auto& [a, b, c] : patch) filled.triangles.push_back({loop[a], loop[b], loop[c]});
    ++filled.holes;
  }
  return filled;
}

}  // namespace cscd::scenes
