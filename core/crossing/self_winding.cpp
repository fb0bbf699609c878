#include "core/crossing/self_winding.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/base/rounding.h"
#include "core/crossing/generic_side.h"
#include "core/mesh/adjacency.h"

namespace cscd {
namespace {

// The vertex of some triangles that lies farthest along an axis, if there is one alone.
std::optional<VertexId> farthest_vertex(const TriangleMesh& mesh, std::span<const Vec3> positions,
                                        std::span<const TriangleId> triangles, int axis, int sign) {
  std::optional<VertexId> best;
  bool alone = true;
  for (const TriangleId t : triangles)
    for (const VertexId v : mesh.corners(t)) {
      if (v == best) continue;
      const double gain = best ? sign * (positions[+v][axis] - positions[+*best][axis]) : 1;
      if (gain < 0) continue;
      if (gain > 0) best = v;
      alone = gain > 0;
    }
  return alone ? best : std::nullopt;
}

// The neighbours of a vertex in the order of its faces, counter-clockwise seen from before these; empty
// unless all faces are in one ring.
std::vector<VertexId> ring_of(const TriangleMesh& mesh, VertexId v) {
  const std::span<const TriangleId> faces = mesh.triangles_at(v);
  const auto next_of = [&](VertexId from) {
    for (const TriangleId t : faces) {
      const Triangle& c = mesh.corners(t);
      for (std::size_t k = 0; k < 3; ++k)
        if (c[k] == v && c[(k + 1) % 3] == from) return c[(k + 2) % 3];
    }
    return VertexId{-1};
  };
  std::vector<VertexId> ring;
  const Triangle& first = mesh.corners(faces.front());
  const auto at = static_cast<std::size_t>(std::ranges::find(first, v) - first.begin());
  for (VertexId u = first[(at + 1) % 3]; ring.empty() || u != ring.front(); u = next_of(u)) {
    if (u == VertexId{-1} || ring.size() == faces.size()) return {};
    ring.push_back(u);
  }
  return ring.size() == faces.size() ? ring : std::vector<VertexId>{};
}

}  // namespace

// Seen from the outermost vertex, its neighbours are the corners of a polygon that does not cross itself. The
// faces look outward if it runs counter-clockwise, and how it runs is seen at its own outermost corner.
std::optional<OutermostVertex> find_outermost_vertex(const TriangleMesh& mesh,
                                                     std::span<const Vec3> positions,
                                                     std::span<const TriangleId> component,
                                                     const std::function<bool(VertexId)>& is_on_curve) {
  GenericSides sides(positions);
  for (int axis = 0; axis < 3; ++axis)
    for (const int sign : {1, -1}) {
      const std::optional<VertexId> v = farthest_vertex(mesh, positions, component, axis, sign);
      if (!v || is_on_curve(*v)) continue;
      const std::vector<VertexId> ring = ring_of(mesh, *v);
      if (ring.size() < 3) continue;
      const int across = (axis + 1) % 3;
      double most = -std::numeric_limits<double>::infinity(), second = most, largest = 0;
      std::size_t corner = 0;
      for (std::size_t i = 0; i < ring.size(); ++i) {
        const Vec3 &x = positions[+*v], &y = positions[+ring[i]];
        const double slope = (y[across] - x[across]) / (sign * (x[axis] - y[axis]));
        largest = std::max(largest, std::abs(slope));
        if (slope > most)
          second = most, most = slope, corner = i;
        else
          second = std::max(second, slope);
      }
      // Each slope is rounded three times.
      if (!std::isfinite(largest) || !(most - second > 1e-14 * largest)) continue;
      const VertexId before = ring[(corner + ring.size() - 1) % ring.size()],
                     after = ring[(corner + 1) % ring.size()];
      const bool outward = sides.side(before, ring[corner], after, *v) < 0;
      return OutermostVertex{*v, outward ? 0 : -1};
    }
  return std::nullopt;
}

bool faces_inward(const TriangleMesh& mesh, std::span<const Vec3> positions,
                  std::span<const TriangleId> component, const std::function<bool(VertexId)>& is_on_curve) {
  double volume = 0, sizes = 0, count = 0;  // six times the volume
  std::optional<Vec3> origin;
  for (const TriangleId t : component) {
    const auto [a, b, c] = mesh.corners(t);
    if (!origin) origin = positions[+a];
    const Vec3 from = positions[+a] - *origin, ab = positions[+b] - positions[+a],
               ac = positions[+c] - positions[+a];
    volume += from.dot(ab.cross(ac));
    sizes += from.norm() * ab.norm() * ac.norm();
    ++count;
  }
  // A term is off by less than 32 units of its size, and each sum of terms by one unit of all sizes.
  if (std::abs(volume) <= (32 + count) * kUnitRoundoff * sizes)
    if (const std::optional<OutermostVertex> known =
            find_outermost_vertex(mesh, positions, component, is_on_curve))
      return known->winding < 0;
  return volume < 0;
}

std::vector<std::optional<int>> spread_winding(std::size_t parts, std::span<const WindingStep> steps,
                                               std::int32_t known, int winding) {
  std::vector<std::optional<int>> found(parts);
  std::vector<std::vector<std::pair<std::int32_t, int>>> next(parts);
  for (const auto& [from, to, more] : steps) {
    next[static_cast<std::size_t>(from)].emplace_back(to, more);
    next[static_cast<std::size_t>(to)].emplace_back(from, -more);
  }
  if (known < 0 || static_cast<std::size_t>(known) >= parts) return found;
  std::vector<std::int32_t> open{known};
  found[static_cast<std::size_t>(known)] = winding;
  for (std::size_t i = 0; i < open.size(); ++i)
    for (const auto& [to, more] : next[static_cast<std::size_t>(open[i])])
      if (!found[static_cast<std::size_t>(to)]) {
        found[static_cast<std::size_t>(to)] = *found[static_cast<std::size_t>(open[i])] + more;
        open.push_back(to);
      }
  return found;
}

}  // namespace cscd
