#include "core/crossing/reach.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace cscd {

// Within one triangle, the part is a union of triangles between its vertices and points of the curves, and
// any point of a triangle is within 1 / sqrt(3) of its longest edge of some corner.
double reach(const TriangleMesh& mesh, std::span<const Vec3> positions, const CrossingCurves& all,
             const CutOffPart& part) {
  const auto on_curve = [&](VertexId v) { return part.is_on_curve[+v] != 0; };
  const auto longest = [&](TriangleId t) {  // edge of a triangle, squared
    const auto [a, b, c] = mesh.corners(t);
    const Vec3 &x = positions[+a], &y = positions[+b], &z = positions[+c];
    return std::max({(x - y).squaredNorm(), (y - z).squaredNorm(), (z - x).squaredNorm()});
  };
  double most = 0;
  for (const VertexId v : part.vertices)
    for (const TriangleId t : mesh.triangles_at(v))
      if (const VertexId first = mesh.corners(t)[0]; !part.is_cut[+t] && (v == first || on_curve(first)))
        most = std::max(most, longest(t));
  // Of triangles that are cut, the points; no two of one triangle are farther from each other than its
  // corners.
  std::vector<std::uint64_t> order;  // a triangle in the upper half, and one of its points in the lower
  std::vector<Vec3> points;
  const auto add = [&](TriangleId t, const Vec3& point) {
    order.push_back(static_cast<std::uint64_t>(+t) << 32 | points.size());
    points.push_back(point);
  };
  for (const std::int32_t image : part.images) {
    const CrossingCurve& curve = all.curves[static_cast<std::size_t>(image / 2)];
    for (std::size_t i = 0; i < curve.segments.size(); ++i) {
      const TriangleId t = curve.segments[i][static_cast<std::size_t>(image % 2)];
      if (longest(t) <= most) continue;
      for (const std::size_t node : {i, (i + 1) % curve.nodes.size()})
        add(t, all.point(curve.nodes[node], positions));
    }
  }
  for (const VertexId v : part.vertices)
    for (const TriangleId t : mesh.triangles_at(v)) {
      if (!part.is_cut[+t] || longest(t) <= most) continue;
      add(t, positions[+v]);
      for (const VertexId corner : mesh.corners(t))
        if (on_curve(corner)) add(t, positions[+corner]);
    }
  std::ranges::sort(order);
  const auto point = [&](std::size_t i) -> const Vec3& { return points[order[i] & 0xffffffff]; };
  for (std::size_t i = 0; i < order.size();) {
    Vec3 low = point(i), high = low;
    const std::size_t first = i;
    for (; i < order.size() && order[i] >> 32 == order[first] >> 32; ++i) {
      low = low.cwiseMin(point(i));
      high = high.cwiseMax(point(i));
    }
    double widest = 0;
    if (i - first <= 8)
      for (std::size_t a = first; a < i; ++a)
        for (std::size_t b = a + 1; b < i; ++b)
          widest = std::max(widest, (point(a) - point(b)).squaredNorm());
    else
      widest = (high - low).squaredNorm();
    most = std::max(most, widest);
  }
  return std::sqrt(most) * std::numbers::inv_sqrt3;
}

}  // namespace cscd
