#include "core/engine/viewpoint.h"

#include <cmath>
#include <limits>

namespace cscd::fast {
namespace {

constexpr int kDescentSteps = 400;

}  // namespace

Face face_of(const TriangleMesh& mesh, std::span<const Vec3> positions, TriangleId triangle) {
  const Triangle& c = mesh.corners(triangle);
  const Vec3 normal = (positions[+c[1]] - positions[+c[0]]).cross(positions[+c[2]] - positions[+c[0]]);
  const double length = normal.norm();
  return {positions[+c[0]] / 3 + positions[+c[1]] / 3 + positions[+c[2]] / 3,
          length > 0 ? Vec3(normal / length) : Vec3(Vec3::Zero())};
}

// How far each face lacks from what is wanted, summed, is convex in the point: subgradient descent, from a
// point inside.
Vec3 best_viewpoint(std::span<const Face> faces) {
  Vec3 q = Vec3::Zero();
  for (const Face& f : faces) q += f.centre / static_cast<double>(faces.size());
  double size = 0;
  for (const Face& f : faces) size += (f.centre - q).norm() / static_cast<double>(faces.size());
  const double room = 0.4 * size;
  Vec3 best = q;
  double least = std::numeric_limits<double>::infinity();
  for (int step = 0; step < kDescentSteps; ++step) {
    double lack = 0;
    Vec3 away = Vec3::Zero();
    for (const Face& f : faces) {
      const double depth = f.normal.dot(f.centre - q);
      if (depth >= room) continue;
      lack += room - depth;
      away += f.normal;
    }
    if (lack < least) {
      least = lack;
      best = q;
    }
    const double length = away.norm();
    if (!(length > 0)) break;
    q -= away * (0.3 * size / (length * std::sqrt(1.0 + step)));
  }
  return best;
}

}  // namespace cscd::fast
