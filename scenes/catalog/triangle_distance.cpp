#include "scenes/catalog/triangle_distance.h"

#include <algorithm>

#include "core/geometry/feature_distance.h"

// Two triangles that do not cross are nearest to each other at a vertex and a face, or at two edges. So
// their distance is the smallest of six vertex-face and nine edge-edge distances. If they cross, an
// edge of one pierces the other.
namespace cscd::scenes {
namespace {

// Returns whether a point of the triangle's plane lies inside the triangle: on the inner side of
// each edge, seen along the normal.
bool above_face(const Vec3& p, const TriangleCorners& t, const Vec3& normal) {
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3& from = t[k];
    if ((t[(k + 1) % 3] - from).cross(p - from).dot(normal) < 0) return false;
  }
  return true;
}

struct Faced {
  const TriangleCorners& corners;
  Vec3 normal;
  explicit Faced(const TriangleCorners& t) : corners(t), normal((t[1] - t[0]).cross(t[2] - t[0])) {}
  double height(const Vec3& p) const { return (p - corners[0]).dot(normal); }  // times the normal's length
};

// Returns the smallest of `least` and the squared distances of one triangle's vertices to the other's face,
// or 0 if an edge pierces that face.
double to_face(const TriangleCorners& from, const Faced& face, double least) {
  const double length = face.normal.squaredNorm();
  if (length == 0) return least;  // the triangle consists of its edges
  double height[3];
  for (std::size_t k = 0; k < 3; ++k) {
    height[k] = face.height(from[k]);
    if (height[k] * height[k] < least * length && above_face(from[k], face.corners, face.normal))
      least = height[k] * height[k] / length;
  }
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t next = (k + 1) % 3;
    if ((height[k] < 0) == (height[next] < 0)) continue;
    const double share = height[k] / (height[k] - height[next]);
    if (above_face(from[k] + share * (from[next] - from[k]), face.corners, face.normal)) return 0;
  }
  return least;
}

}  // namespace

double triangle_distance(const TriangleCorners& a, const TriangleCorners& b) {
  double least = (a[0] - b[0]).squaredNorm();
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      least = std::min(least, squared_segment_distance(a[i], a[(i + 1) % 3], b[j], b[(j + 1) % 3]));
  least = to_face(a, Faced(b), least);
  least = to_face(b, Faced(a), least);
  return std::sqrt(least);
}

}  // namespace cscd::scenes
