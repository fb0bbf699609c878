#include "scenes/shape/surface_details.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "scenes/shape/circle.h"

namespace cscd::scenes {
namespace {

double displacement(const SurfaceDetail& detail, const Vec3& x) {
  const Vec3 off = x - detail.at;
  const Vec3 shares = off.cwiseQuotient(detail.reach);
  const double inside = 1 - shares.squaredNorm();
  if (!(inside > 0)) return 0;
  double height = detail.height * inside * inside;
  if (detail.rim > 0) {
    const double risen = std::min(1.0, (1 - shares.norm()) / detail.rim);
    height = detail.height * risen * risen * (3 - 2 * risen);
  }
  const double fold =
      detail.wave_length > 0 ? circle_point(off.dot(detail.across) / detail.wave_length).cosine : 1;
  return height * fold;
}

// The sum of the area vectors round every vertex, scaled to length 1.
std::vector<Vec3> vertex_normals(const Shape& shape) {
  std::vector<Vec3> normals(shape.positions.size(), Vec3::Zero());
  for (const Triangle& t : shape.triangles) {
    const Vec3& a = shape.positions[+t[0]];
    const Vec3 twice = (shape.positions[+t[1]] - a).cross(shape.positions[+t[2]] - a);
    for (const VertexId vertex : t) normals[+vertex] += twice;
  }
  for (Vec3& normal : normals) normal.stableNormalize();
  return normals;
}

const ParameterRow kRows[] = {
    vector_row("at", "length", "middle of the place, at rest"),
    vector_row("reach", "length", "half axes of the ellipsoid in which the place lies, along x, y and z"),
    number_row("height", "length", "displacement along the surface's normals, negative for a dent"),
    number_row("wave_length", "length", "distance from one fold to the next; without it there are no folds",
               {1e-9, 1e12})
        .optional(),
    vector_row("across", "", "direction from fold to fold; folds need it").optional(),
    vector_row("lean", "height", "displacement beside that along the normals, in heights; makes overhangs")
        .optional(),
    number_row("rim", "", "share of the reach over which the height is lost; without it the place is rounded",
               {0.01, 1})
        .optional(),
    integer_row("mirrored", "", "1 for a second place with x negated", {0, 1}).or_else({0}),
};

}  // namespace

void add_details(std::span<const SurfaceDetail> details, Shape& shape) {
  if (details.empty()) return;
  const std::vector<Vec3> normals = vertex_normals(shape);
  for (std::size_t v = 0; v < normals.size(); ++v) {
    double height = 0;
    Vec3 leant = Vec3::Zero();
    for (const SurfaceDetail& detail : details) {
      const double own = displacement(detail, shape.positions[v]);
      height += own;
      leant += own * detail.lean;
    }
    shape.positions[v] += height * normals[v] + leant;
  }
}

std::span<const ParameterRow> detail_rows() {
  return kRows;
}

std::vector<SurfaceDetail> read_details(std::span<const Parameters> objects) {
  std::vector<SurfaceDetail> details;
  for (const Parameters& p : objects) {
    SurfaceDetail detail{p.vector("at"), p.vector("reach"), p.number("height"), p.number("wave_length", 0),
                         p.vector("across", Vec3::Zero())};
    detail.lean = p.vector("lean", Vec3::Zero());
    detail.rim = p.number("rim", 0);
    if (!(detail.reach.minCoeff() > 0))
      throw InputError(p.where() + ": parameter reach must be positive along x, y and z");
    if (p.has("wave_length") != (detail.across.squaredNorm() > 0))
      throw InputError(p.where() + ": folds need both wave_length and a direction across that is not zero");
    if (p.has("wave_length")) detail.across.normalize();
    details.push_back(detail);
    if (p.integer("mirrored") == 0) continue;
    detail.at.x() *= -1;
    detail.across.x() *= -1;
    detail.lean.x() *= -1;
    details.push_back(detail);
  }
  return details;
}

}  // namespace cscd::scenes
