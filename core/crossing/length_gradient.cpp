#include "core/crossing/length_gradient.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/geometry/unit_scale.h"

namespace cscd {
namespace {

// Positions in the scale in which coordinates are about 1. The formulas multiply up to four lengths.
struct ScaledPositions {
  std::span<const Vec3> positions;
  double scale;
  Vec3 operator[](VertexId v) const { return scale * positions[+v]; }
};

ScaledPositions scaled(const TriangleMesh& mesh, std::span<const Vec3> positions, const CrossingCurves& all,
                       const Overlap& overlap) {
  double largest = 0;
  for_each_segment(all, overlap, [&](const auto& segment) {
    for (const TriangleId t : segment)
      for (const VertexId v : mesh.corners(t))
        largest = std::max(largest, positions[+v].cwiseAbs().maxCoeff());
  });
  return {positions, unit_scale(largest)};
}

// Adds what follows for the vertices of a piercing from `pull`, the gradient of the length by the point of
// the piercing. The point is moved by the edge, and slides along the edge to stay in the plane of the face.
void add_piercing(const TriangleMesh& mesh, const ScaledPositions& x, const Piercing& piercing,
                  const Vec3& pull, std::map<VertexId, Vec3>& gradient) {
  const auto [a, b] = mesh.ends(piercing.edge);
  const auto [c, d, e] = mesh.corners(piercing.face);
  const Vec3 point = x.scale * piercing.point;
  const Vec3 edge = x[b] - x[a], normal = (x[d] - x[c]).cross(x[e] - x[c]);
  const double share = edge.dot(point - x[a]) / edge.squaredNorm();
  const double of_d = normal.dot((point - x[c]).cross(x[e] - x[c])) / normal.squaredNorm(),
               of_e = normal.dot((x[d] - x[c]).cross(point - x[c])) / normal.squaredNorm();
  const Vec3 by_face = (pull.dot(edge) / normal.dot(edge)) * normal, by_edge = pull - by_face;
  if (!by_face.allFinite() || !std::isfinite(share) || !std::isfinite(of_d + of_e)) return;
  const auto add = [&](VertexId v, const Vec3& g) {
    gradient.try_emplace(v, Vec3::Zero()).first->second += g;
  };
  add(a, (1 - share) * by_edge);
  add(b, share * by_edge);
  add(c, (1 - of_d - of_e) * by_face);
  add(d, of_d * by_face);
  add(e, of_e * by_face);
}

}  // namespace

CurveLength length_gradient(const TriangleMesh& mesh, std::span<const Vec3> positions,
                            const CrossingCurves& all, const Overlap& overlap) {
  const ScaledPositions x = scaled(mesh, positions, all, overlap);
  CurveLength out;
  std::map<VertexId, Vec3> gradient;
  for (const std::int32_t number : overlap.curves) {
    const CrossingCurve& curve = all.curves[static_cast<std::size_t>(number)];
    std::vector<Vec3> pull(curve.nodes.size(), Vec3::Zero());
    for (std::size_t i = 0; i < curve.segments.size(); ++i) {
      const std::size_t next = (i + 1) % curve.nodes.size();
      const Vec3 way =
          x.scale * all.point(curve.nodes[next], positions) - x.scale * all.point(curve.nodes[i], positions);
      const double length = way.norm();
      if (length == 0) continue;
      out.length += length;
      pull[next] += way / length;
      pull[i] -= way / length;
    }
    for (std::size_t i = 0; i < curve.nodes.size(); ++i) {
      const CrossingCurve::Node& node = curve.nodes[i];
      if (node.piercing >= 0)
        add_piercing(mesh, x, all.piercings[static_cast<std::size_t>(node.piercing)], pull[i], gradient);
      else
        gradient.try_emplace(node.vertex, Vec3::Zero()).first->second += pull[i];
    }
  }
  out.length /= x.scale;
  out.gradient.assign(gradient.begin(), gradient.end());
  return out;
}

}  // namespace cscd
