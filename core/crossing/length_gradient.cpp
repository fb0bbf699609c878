#include "core/crossing/length_gradient.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace cscd {
namespace {

// Adds what follows for the vertices of a piercing from `pull`, the gradient of the length by the point of
// the piercing. The point is moved by the edge, and slides along the edge to stay in the plane of the face.
void add_piercing(const TriangleMesh& mesh, std::span<const Vec3> x, const Piercing& piercing,
                  const Vec3& pull, std::map<VertexId, Vec3>& gradient) {
  const auto [a, b] = mesh.ends(piercing.edge);
  const auto [c, d, e] = mesh.corners(piercing.face);
  const Vec3 edge = x[+b] - x[+a], normal = (x[+d] - x[+c]).cross(x[+e] - x[+c]);
  const double share = edge.dot(piercing.point - x[+a]) / edge.squaredNorm();
  const double of_d = normal.dot((piercing.point - x[+c]).cross(x[+e] - x[+c])) / normal.squaredNorm(),
               of_e = normal.dot((x[+d] - x[+c]).cross(piercing.point - x[+c])) / normal.squaredNorm();
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
  CurveLength out;
  std::map<VertexId, Vec3> gradient;
  for (const std::int32_t number : overlap.curves) {
    const CrossingCurve& curve = all.curves[static_cast<std::size_t>(number)];
    std::vector<Vec3> pull(curve.nodes.size(), Vec3::Zero());
    for (std::size_t i = 0; i < curve.segments.size(); ++i) {
      const std::size_t next = (i + 1) % curve.nodes.size();
      const Vec3 way = all.point(curve.nodes[next], positions) - all.point(curve.nodes[i], positions);
      const double length = way.norm();
      if (length == 0) continue;
      out.length += length;
      pull[next] += way / length;
      pull[i] -= way / length;
    }
    for (std::size_t i = 0; i < curve.nodes.size(); ++i) {
      const CrossingCurve::Node& node = curve.nodes[i];
      if (node.piercing >= 0)
        add_piercing(mesh, positions, all.piercings[static_cast<std::size_t>(node.piercing)], pull[i],
                     gradient);
      else
        gradient.try_emplace(node.vertex, Vec3::Zero()).first->second += pull[i];
    }
  }
  out.gradient.assign(gradient.begin(), gradient.end());
  return out;
}

}  // namespace cscd
