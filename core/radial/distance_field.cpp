#include "core/radial/distance_field.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "core/radial/nearest_point.h"

// Makes the discrete signed distance field of a closed surface in three steps.
//
// Step 1. Up to one cell away from the surface, a cell gets the exact distance to the nearest triangle. Each
// triangle visits the cells round it, which are found by splitting its box of cells and dropping the parts
// that are too far away.
//
// Step 2. Elsewhere, a cell gets the distance to the nearest cell centre near the surface, by the separable
// lower envelope of parabolas (Felzenszwalb and Huttenlocher, "Distance Transforms of Sampled Functions",
// Theory of Computing 8, 2012, section 2). The distance is off by half a diagonal at most, which its users
// allow for.
//
// Step 3. The sign comes from the winding number along the rows of the grid: each triangle adds +-1 behind
// the point where a row meets it. Whether a row meets a triangle is decided edge by edge, antisymmetrically,
// so that along every row of a closed surface the additions cancel, whatever rounding does.
//
// Takes time linear in the cells, plus the triangles times the cells in their vicinity. Takes memory of a
// float and an int32 a cell.

namespace cscd::radial {
namespace {

constexpr double kMostCells = 1 << 25;  // 128 MiB of distances
constexpr float kFar = std::numeric_limits<float>::infinity();

using Cell = std::array<int, 3>;

// Returns the index, along one axis, of the cells that hold the coordinate. The index is not clamped to the
// grid.
int slab(const DistanceField& field, int axis, double coordinate) {
  return static_cast<int>(std::floor((coordinate - field.corner[axis]) / field.cell));
}

DistanceField make_grid(const Eigen::AlignedBox3d& box, int resolution) {
  const double longest = box.sizes().maxCoeff();
  DistanceField field;
  field.cell = longest > 0 ? longest / std::max(resolution, 1) : 1;
  const auto cells_along = [&](int axis) { return std::floor(box.sizes()[axis] / field.cell) + 3; };
  while (cells_along(0) * cells_along(1) * cells_along(2) > kMostCells) field.cell *= 1.125;
  for (int axis = 0; axis < 3; ++axis)
    field.size[static_cast<std::size_t>(axis)] = static_cast<int>(cells_along(axis));
  field.corner = box.min() - Vec3::Constant(field.cell);
  field.distance.assign(field.index(0, 0, field.size[2]), kFar);
  return field;
}

// A triangle with a ball round it, which is cheaper to test than the triangle.
struct Patch {
  Vec3 a, b, c, middle;
  double radius;

  Patch(const Vec3& a_, const Vec3& b_, const Vec3& c_) : a(a_), b(b_), c(c_), middle((a_ + b_ + c_) / 3) {
    radius = std::sqrt(
        std::max({(a - middle).squaredNorm(), (b - middle).squaredNorm(), (c - middle).squaredNorm()}));
  }
  double distance(const Vec3& p) const { return (p - nearest_on_triangle(p, a, b, c)).norm(); }
};

// Lowers the distances of the cells from `low` to `high`, both included, to their distance from the triangle,
// where that is at most the length of a cell.
void lower_about(const Patch& patch, const Cell& low, const Cell& high, DistanceField& field) {
  const Cell extent{high[0] - low[0] + 1, high[1] - low[1] + 1, high[2] - low[2] + 1};
  const auto longest =
      static_cast<std::size_t>(std::max_element(extent.begin(), extent.end()) - extent.begin());
  if (extent[longest] > 4) {
    const Vec3 middle = (field.centre(low[0], low[1], low[2]) + field.centre(high[0], high[1], high[2])) / 2;
    const double radius = (field.centre(high[0], high[1], high[2]) - middle).norm();  // of the centres
    if (patch.distance(middle) > radius + field.cell) return;
    Cell left_high = high, right_low = low;
    left_high[longest] = low[longest] + extent[longest] / 2 - 1;
    right_low[longest] = left_high[longest] + 1;
    lower_about(patch, low, left_high, field);
    lower_about(patch, right_low, high, field);
    return;
  }
  for (int z = low[2]; z <= high[2]; ++z)
    for (int y = low[1]; y <= high[1]; ++y)
      for (int x = low[0]; x <= high[0]; ++x) {
        const Vec3 p = field.centre(x, y, z);
        float& known = field.distance[field.index(x, y, z)];
        const double reach = patch.radius + std::min(static_cast<double>(known), field.cell);
        if ((p - patch.middle).squaredNorm() > reach * reach) continue;
        const double d = patch.distance(p);
        if (d <= field.cell) known = std::min(known, static_cast<float>(d));
      }
}

void fill_near(const TriangleMesh& mesh, std::span<const Vec3> positions, DistanceField& field) {
  for (const Triangle& t : mesh.triangles()) {
    const Patch patch(positions[+t[0]], positions[+t[1]], positions[+t[2]]);
    const Vec3 box_low = patch.a.cwiseMin(patch.b).cwiseMin(patch.c),
               box_high = patch.a.cwiseMax(patch.b).cwiseMax(patch.c);
    Cell low, high;
    for (int axis = 0; axis < 3; ++axis) {
      const auto i = static_cast<std::size_t>(axis);
      low[i] = std::clamp(slab(field, axis, box_low[axis]) - 1, 0, field.size[i] - 1);
      high[i] = std::clamp(slab(field, axis, box_high[axis]) + 1, 0, field.size[i] - 1);
    }
    lower_about(patch, low, high, field);
  }
}

// Transforms one line of cells: squared[i] becomes the least squared[j] + (i - j)^2 over all j, in cells.
struct LowerEnvelope {
  std::vector<float> value;
  std::vector<int> site;     // the cells whose parabolas make up the envelope, in order
  std::vector<double> from;  // where the parabola of site k begins to be the lowest

  void transform(float* squared, std::size_t count, std::size_t stride) {
    value.resize(count);
    site.resize(count);
    from.resize(count + 1);
    int last = -1;
    for (std::size_t i = 0; i < count; ++i) {
      value[i] = squared[i * stride];
      if (value[i] == kFar) continue;
      double start = -std::numeric_limits<double>::infinity();
      while (last >= 0) {
        const int j = site[static_cast<std::size_t>(last)];
        const double x = static_cast<double>(i);
        start = (static_cast<double>(value[i]) - static_cast<double>(value[static_cast<std::size_t>(j)]) +
                 x * x - static_cast<double>(j) * j) /
                (2 * (x - j));
        if (start > from[static_cast<std::size_t>(last)]) break;
        start = -std::numeric_limits<double>::infinity();
        --last;
      }
      ++last;
      site[static_cast<std::size_t>(last)] = static_cast<int>(i);
      from[static_cast<std::size_t>(last)] = start;
    }
    if (last < 0) return;
    from[static_cast<std::size_t>(last) + 1] = std::numeric_limits<double>::infinity();
    std::size_t k = 0;
    for (std::size_t i = 0; i < count; ++i) {
      while (from[k + 1] < static_cast<double>(i)) ++k;
      const float step = static_cast<float>(i) - static_cast<float>(site[k]);
      squared[i * stride] = value[static_cast<std::size_t>(site[k])] + step * step;
    }
  }
};

void fill_far(DistanceField& field) {
  // Every point of the surface lies within half a diagonal of the centre of its cell. So the sites are the
  // centres that are so near to the surface. Squared distances in cells are integers below 2^24, or lose a
  // relative 2^-24.
  const auto near = static_cast<float>(field.half_diagonal());
  std::vector<float> squared(field.distance.size());
  for (std::size_t i = 0; i < squared.size(); ++i) squared[i] = field.distance[i] <= near ? 0 : kFar;

  LowerEnvelope envelope;
  const auto nx = static_cast<std::size_t>(field.size[0]), ny = static_cast<std::size_t>(field.size[1]),
             nz = static_cast<std::size_t>(field.size[2]);
  for (std::size_t row = 0; row < ny * nz; ++row) envelope.transform(&squared[row * nx], nx, 1);
  for (std::size_t z = 0; z < nz; ++z)
    for (std::size_t x = 0; x < nx; ++x) envelope.transform(&squared[z * nx * ny + x], ny, nx);
  for (std::size_t i = 0; i < nx * ny; ++i) envelope.transform(&squared[i], nz, nx * ny);

  for (std::size_t i = 0; i < squared.size(); ++i)
    if (field.distance[i] == kFar) field.distance[i] = static_cast<float>(field.cell) * std::sqrt(squared[i]);
}

// Returns whether the edge from a to b, projected along x, crosses the half-line from (y, z) towards greater
// y: +1 if it crosses upward, -1 if downward, 0 if not at all. Antisymmetric in a and b.
int crossing(const Vec3& a, const Vec3& b, double y, double z) {
  if ((a.z() > z) == (b.z() > z)) return 0;
  const double side = (a.y() - y) * (b.z() - z) - (b.y() - y) * (a.z() - z);
  if (b.z() > z) return side > 0 ? 1 : 0;
  return side < 0 ? -1 : 0;
}

void apply_sign(const TriangleMesh& mesh, std::span<const Vec3> positions, DistanceField& field) {
  const auto nx = static_cast<std::size_t>(field.size[0]);
  std::vector<std::int32_t> winding(field.distance.size(), 0);  // its steps along each row
  for (const Triangle& t : mesh.triangles()) {
    const Vec3 &a = positions[+t[0]], &b = positions[+t[1]], &c = positions[+t[2]];
    const Vec3 low = a.cwiseMin(b).cwiseMin(c), high = a.cwiseMax(b).cwiseMax(c);
    const Vec3 normal = (b - a).cross(c - a);
    const int y_last = std::min(slab(field, 1, high.y()), field.size[1] - 1);
    const int z_last = std::min(slab(field, 2, high.z()), field.size[2] - 1);
    for (int z = std::max(slab(field, 2, low.z()), 0); z <= z_last; ++z)
      for (int y = std::max(slab(field, 1, low.y()), 0); y <= y_last; ++y) {
        const Vec3 p = field.centre(0, y, z);
        const int turns =
            crossing(a, b, p.y(), p.z()) + crossing(b, c, p.y(), p.z()) + crossing(c, a, p.y(), p.z());
        if (turns == 0) continue;
        // The x at which the row meets the triangle's plane. If the plane is parallel to the row, the
        // quotient may be anything, so x is kept within the triangle's box.
        const double depth =
            a.x() - (normal.y() * (p.y() - a.y()) + normal.z() * (p.z() - a.z())) / normal.x();
        const double x = depth >= low.x() && depth <= high.x() ? depth : (low.x() + high.x()) / 2;
        const int first = static_cast<int>(std::ceil((x - field.corner.x()) / field.cell - 0.5));
        winding[field.index(std::clamp(first, 0, field.size[0] - 1), y, z)] -= turns;
      }
  }
  for (std::size_t row = 0; row < winding.size(); row += nx) {
    std::int32_t turns = 0;
    for (std::size_t i = row; i < row + nx; ++i) {
      turns += winding[i];
      if (turns != 0) field.distance[i] = -field.distance[i];
    }
  }
}

}  // namespace

double DistanceField::at(const Vec3& point) const {
  const Vec3 local = (point - corner) / cell, high(size[0], size[1], size[2]);
  if ((local.array() < 0).any() || (local.array() >= high.array()).any())
    return cell * (1 + (local - local.cwiseMax(0).cwiseMin(high)).norm());
  return static_cast<double>(
      distance[index(static_cast<int>(local.x()), static_cast<int>(local.y()), static_cast<int>(local.z()))]);
}

DistanceField make_distance_field(const TriangleMesh& mesh, std::span<const Vec3> positions,
                                  int cells_along_longest_side) {
  DistanceField field = make_grid(surface_box(mesh, positions), cells_along_longest_side);
  fill_near(mesh, positions, field);
  fill_far(field);
  apply_sign(mesh, positions, field);
  return field;
}

int resolution_of_mean_edge(const TriangleMesh& mesh, std::span<const Vec3> positions) {
  double total = 0;
  for (const Edge& e : mesh.edges()) total += (positions[+e[1]] - positions[+e[0]]).norm();
  const double cells =
      surface_box(mesh, positions).sizes().maxCoeff() * static_cast<double>(mesh.edge_count()) / total;
  constexpr double most = 1 << 15;  // far more than the bound on the number of cells allows
  return cells >= 1 ? static_cast<int>(std::min(std::ceil(cells), most)) : 1;
}

bool runs_inside(const DistanceField& field, const Vec3& from, const Vec3& to) {
  const Vec3 way = to - from;
  const double length = way.norm();
  if (!std::isfinite(length)) return false;
  // A point is certainly outside if the centre of its cell lies farther outside than that centre is from the
  // point.
  const double slack = field.half_diagonal();
  const Vec3 direction = length > 0 ? Vec3(way / length) : Vec3::Zero();
  for (double done = 0;;) {
    const double distance = field.at(from + done * direction);
    if (distance > slack) return false;
    if (done >= length) return true;
    // Deep inside, no point within the distance less two slacks can be outside: one slack for the point's
    // distance from the centre of its cell, one for the error of the field.
    done = std::min(length, done + std::max(field.cell / 2, -distance - 2 * slack));
  }
}

}  // namespace cscd::radial
