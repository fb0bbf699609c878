#include "core/fast/clusters/best_viewpoint.h"

#include <cmath>
#include <limits>
#include <vector>

#include "core/geometry/simd_doubles.h"

namespace cscd::fast {
namespace {

// By how much eight faces lack what is wanted, at the middle and along their normals. Unused lanes lack
// nothing.
struct Lacks {
  Lane8 normal[3] = {}, at_middle = {};

  // Adds what the faces lack at the point, and the normals of those that lack anything.
  void add(const Vec3& point, Lane8& lack, Lane8 (&away)[3]) const {
    const Lane8 here = at_middle + normal[0] * point[0] + normal[1] * point[1] + normal[2] * point[2];
    const Sign8 lacking = here > 0;
    lack += select(lacking, here, Lane8{});
    for (int k = 0; k < 3; ++k) away[k] += select(lacking, normal[k], Lane8{});
  }
};

double sum_of(const Lane8& lanes) {
  double sum = 0;
  for (std::size_t i = 0; i < kLanes; ++i) sum += lanes[i];
  return sum;
}

}  // namespace

Face face_of(const TriangleMesh& mesh, std::span<const Vec3> positions, TriangleId triangle) {
  const Triangle& c = mesh.corners(triangle);
  const Vec3 normal = (positions[+c[1]] - positions[+c[0]]).cross(positions[+c[2]] - positions[+c[0]]);
  const double length = normal.norm();
  return {positions[+c[0]] / 3 + positions[+c[1]] / 3 + positions[+c[2]] / 3,
          length > 0 ? Vec3(normal / length) : Vec3(Vec3::Zero())};
}

// The sum of what the faces lack is convex in the point. Subgradient descent minimises that sum, and begins
// at a point inside.
Vec3 best_viewpoint(std::span<const Face> faces, int steps) {
  Vec3 middle = Vec3::Zero();
  for (const Face& f : faces) middle += f.centre / static_cast<double>(faces.size());
  double size = 0;
  for (const Face& f : faces) size += (f.centre - middle).norm() / static_cast<double>(faces.size());

  // Points are measured from the middle.
  std::vector<Lacks> rows((faces.size() + kLanes - 1) / kLanes);
  for (std::size_t i = 0; i < faces.size(); ++i) {
    Lacks& row = rows[i / kLanes];
    const std::size_t lane = i % kLanes;
    for (int k = 0; k < 3; ++k) row.normal[k][lane] = faces[i].normal[k];
    row.at_middle[lane] = 0.4 * size - faces[i].normal.dot(faces[i].centre - middle);
  }
  Vec3 q = Vec3::Zero(), best = q;
  double least = std::numeric_limits<double>::infinity();
  for (int step = 0; step < steps; ++step) {
    Lane8 lacks = {}, normals[3] = {};
    for (const Lacks& row : rows) row.add(q, lacks, normals);
    const double lack = sum_of(lacks);
    if (lack < least) {
      least = lack;
      best = q;
    }
    const Vec3 away(sum_of(normals[0]), sum_of(normals[1]), sum_of(normals[2]));
    const double length = away.norm();
    if (!(length > 0)) break;
    q -= away * (0.3 * size / (length * std::sqrt(1.0 + step)));
  }
  return middle + best;
}

}  // namespace cscd::fast
