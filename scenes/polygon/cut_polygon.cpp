#include "scenes/polygon/cut_polygon.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <utility>

#include "scenes/polygon/clipped_ears.h"
#include "scenes/polygon/triangulated_loop.h"

namespace cscd::scenes {
namespace {

using Corners = std::vector<std::int32_t>;
using Triangles = std::vector<std::array<std::int32_t, 3>>;

// Where the diagonals' lengths are equal up to rounding, the diagonal from the first corner is chosen, as
// most programs do.
constexpr double kEqualLengths = 1e-9;
// A polygon whose corners lie at most this share of its length beside a plane counts as flat, and one whose
// area is at most this share of the square of its length encloses nothing.
constexpr double kFlat = 1e-6, kNoArea = 1e-14;

const Vec3& at(std::span<const Vec3> positions, std::int32_t corner) {
  return positions[static_cast<std::size_t>(corner)];
}

void add_fan(std::span<const std::int32_t> corners, Triangles& triangles) {
  for (std::size_t k = 2; k < corners.size(); ++k)
    triangles.push_back({corners[0], corners[k - 1], corners[k]});
}

void cut_quadrilateral(std::span<const std::int32_t> c, std::span<const Vec3> positions,
                       Triangles& triangles) {
  const auto corner = [&](std::size_t k) -> const Vec3& { return at(positions, c[k % 4]); };
  const Vec3 first = corner(2) - corner(0), second = corner(3) - corner(1), normal = first.cross(second);
  // The diagonal from corner k lies inside if both triangles beside it turn as the whole quadrilateral does.
  const auto inside = [&](std::size_t k) {
    const Vec3 one = (corner(k + 1) - corner(k)).cross(corner(k + 2) - corner(k)),
               other = (corner(k + 2) - corner(k)).cross(corner(k + 3) - corner(k));
    return one.dot(normal) > 0 && other.dot(normal) > 0;
  };
  const bool first_inside = inside(0), second_inside = inside(1);
  const bool first_shorter = first.squaredNorm() <= second.squaredNorm() * (1 + kEqualLengths);
  if (first_inside == second_inside ? first_shorter : first_inside) {
    triangles.push_back({c[0], c[1], c[2]});
    triangles.push_back({c[0], c[2], c[3]});
  } else {
    triangles.push_back({c[0], c[1], c[3]});
    triangles.push_back({c[1], c[2], c[3]});
  }
}

// Cuts off, by triangles without extent, the corners that lie where the corner before them lies. Such
// corners would turn one edge that a polygon runs along twice into two edges.
Corners without_repeats(std::span<const std::int32_t> corners, std::span<const Vec3> positions,
                        Triangles& triangles) {
  const auto same = [&](std::int32_t a, std::int32_t b) { return at(positions, a) == at(positions, b); };
  Corners kept{corners.front()};
  std::size_t left = corners.size();
  for (std::size_t k = 1; k < corners.size(); ++k) {
    if (left > 3 && same(kept.back(), corners[k])) {
      triangles.push_back({kept.back(), corners[k], k + 1 < corners.size() ? corners[k + 1] : kept.front()});
      --left;
    } else {
      kept.push_back(corners[k]);
    }
  }
  while (kept.size() > 3 && same(kept.back(), kept.front())) {
    triangles.push_back({kept[kept.size() - 2], kept.back(), kept.front()});
    kept.pop_back();
  }
  return kept;
}

// The plane that a polygon lies in or near, and how long the polygon's border is.
struct Plane {
  Vec3 normal;  // of length 1, or zero for a polygon without area
  double length = 0;
  bool flat = true;
};

Plane plane_of(std::span<const std::int32_t> corners, std::span<const Vec3> positions) {
  Plane plane{Vec3::Zero()};
  const Vec3& start = at(positions, corners.front());
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const Vec3 &a = at(positions, corners[k]), &b = at(positions, corners[(k + 1) % corners.size()]);
    plane.normal += (a - start).cross(b - start);
    plane.length += (b - a).norm();
  }
  const double area = plane.normal.norm();
  plane.normal = area > kNoArea * plane.length * plane.length ? Vec3(plane.normal / area) : Vec3::Zero();
  for (const std::int32_t corner : corners)
    if (std::abs((at(positions, corner) - start).dot(plane.normal)) > kFlat * plane.length)
      plane.flat = false;
  return plane;
}

// Tells whether a triangle faces the other way than its polygon. Of a polygon whose parts turn against each
// other and are equally large, every triangle with area does.
bool turned(const std::array<std::int32_t, 3>& t, std::span<const Vec3> positions, const Plane& plane) {
  const Vec3& a = at(positions, t[0]);
  const Vec3 normal = (at(positions, t[1]) - a).cross(at(positions, t[2]) - a);
  const double most = kNoArea * plane.length * plane.length;
  return plane.normal.isZero(0) ? normal.norm() > most : normal.dot(plane.normal) < -most;
}

Triangles named(std::span<const std::array<std::size_t, 3>> cut, std::span<const std::int32_t> corners) {
  Triangles triangles;
  for (const auto& [a, b, c] : cut) triangles.push_back({corners[a], corners[b], corners[c]});
  return triangles;
}

// Cuts a polygon of five corners or more. CGAL's way fails where a polygon touches itself in a corner, so
// ears are cut off there.
Triangles cut_many(std::span<const std::int32_t> corners, std::span<const Vec3> positions,
                   const Plane& plane) {
  std::vector<Vec3> loop;
  for (const std::int32_t corner : corners) loop.push_back(at(positions, corner));
  const auto is_turned = [&](const auto& t) { return turned(t, positions, plane); };
  Triangles triangles = named(triangulated_loop(loop, LoopKind::polygon), corners);
  if (!triangles.empty() && std::ranges::none_of(triangles, is_turned)) return triangles;
  const Triangles ears = named(clipped_ears(loop, plane.normal), corners);
  return ears.empty() ? triangles : ears;
}

// The corners of a polygon in their order, scaled by a power of two so that the largest coordinate is about
// 1. The products of coordinates of very small or very large polygons would vanish or overflow otherwise.
std::vector<Vec3> at_unit_size(std::span<const std::int32_t> corners, std::span<const Vec3> positions) {
  std::vector<Vec3> loop;
  double largest = 0;
  for (const std::int32_t corner : corners) {
    loop.push_back(at(positions, corner));
    largest = std::max(largest, loop.back().cwiseAbs().maxCoeff());
  }
  if (largest == 0) return loop;
  const int exponent = std::ilogb(largest);
  for (Vec3& x : loop)
    for (double& coordinate : x) coordinate = std::ldexp(coordinate, -exponent);
  return loop;
}

Corners numbered(std::size_t count) {
  Corners corners(count);
  std::iota(corners.begin(), corners.end(), 0);
  return corners;
}

bool are_finite(std::span<const std::int32_t> corners, std::span<const Vec3> positions) {
  return std::ranges::all_of(corners, [&](std::int32_t corner) { return at(positions, corner).allFinite(); });
}

PolygonCut cut_loop(std::span<const Vec3> loop, Triangles& triangles) {
  const Corners kept = without_repeats(numbered(loop.size()), loop, triangles);
  const Plane plane = plane_of(kept, loop);
  Triangles cut;
  if (kept.size() == 4) {
    cut_quadrilateral(kept, loop, cut);
  } else if (kept.size() == 3 ||
             plane.normal.isZero(0)) {  // without area, all ways to cut it are equally good
    add_fan(kept, cut);
  } else {
    cut = cut_many(kept, loop, plane);
  }
  triangles.insert(triangles.end(), cut.begin(), cut.end());
  if (cut.empty()) return PolygonCut::none;
  const bool overlapping =
      plane.flat && std::ranges::any_of(cut, [&](const auto& t) { return turned(t, loop, plane); });
  return overlapping ? PolygonCut::overlapping : PolygonCut::good;
}

}  // namespace

PolygonCut cut_polygon(std::span<const std::int32_t> corners, std::span<const Vec3> positions,
                       Triangles& triangles) {
  if (corners.size() == 3 || !are_finite(corners, positions)) {
    add_fan(corners, triangles);
    return PolygonCut::good;
  }
  Triangles cut;
  const PolygonCut result = cut_loop(at_unit_size(corners, positions), cut);
  for (const auto& [a, b, c] : cut)
    triangles.push_back({corners[static_cast<std::size_t>(a)], corners[static_cast<std::size_t>(b)],
                         corners[static_cast<std::size_t>(c)]});
  return result;
}

bool has_area(std::span<const std::int32_t> corners, std::span<const Vec3> positions) {
  if (!are_finite(corners, positions)) return false;
  const std::vector<Vec3> loop = at_unit_size(corners, positions);
  return !plane_of(numbered(loop.size()), loop).normal.isZero(0);
}

}  // namespace cscd::scenes
