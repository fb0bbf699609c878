#include "scenes/polygon/clipped_ears.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <algorithm>
#include <cmath>
#include <utility>

namespace cscd::scenes {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_2;

constexpr std::size_t kMostCorners = 256;

// Leaves out the axis along which the normal is longest, so that the polygon runs counter-clockwise.
std::vector<Point> seen_along(const Vec3& normal, std::span<const Vec3> loop) {
  int axis = 0;
  normal.cwiseAbs().maxCoeff(&axis);
  int x = (axis + 1) % 3, y = (axis + 2) % 3;
  if (normal[axis] < 0) std::swap(x, y);
  std::vector<Point> points;
  for (const Vec3& p : loop) points.emplace_back(p[x], p[y]);
  return points;
}

class EarClipper {
 public:
  explicit EarClipper(std::vector<Point> points) : points_(std::move(points)) {
    for (std::size_t k = 0; k < points_.size(); ++k) left_.push_back(k);
  }

  std::vector<std::array<std::size_t, 3>> clip() {
    std::vector<std::array<std::size_t, 3>> triangles;
    while (left_.size() > 3) {
      std::size_t ear = find([&](std::size_t k) { return is_tip(k); });
      if (ear == left_.size()) ear = find([&](std::size_t k) { return is_ear(k); });
      if (ear == left_.size()) ear = find([&](std::size_t k) { return turn(k) == CGAL::COLLINEAR; });
      if (ear == left_.size()) return {};
      triangles.push_back(triangle(ear));
      left_.erase(left_.begin() + static_cast<std::ptrdiff_t>(ear));
    }
    if (turn(1) == CGAL::RIGHT_TURN) return {};
    triangles.push_back(triangle(1));
    for (auto& t : triangles) std::ranges::sort(t);
    return triangles;
  }

 private:
  std::size_t before(std::size_t k) const { return (k + left_.size() - 1) % left_.size(); }
  std::size_t after(std::size_t k) const { return (k + 1) % left_.size(); }
  const Point& point(std::size_t k) const { return points_[left_[k]]; }
  std::array<std::size_t, 3> triangle(std::size_t k) const {
    return {left_[before(k)], left_[k], left_[after(k)]};
  }
  CGAL::Orientation turn(std::size_t k) const {
    return CGAL::orientation(point(before(k)), point(k), point(after(k)));
  }

  // Returns the first corner for which a test holds, or the number of corners.
  template <class Test>
  std::size_t find(const Test& test) const {
    std::size_t k = 0;
    while (k < left_.size() && !test(k)) ++k;
    return k;
  }

  // Tells whether a corner is the tip of a tail, which runs back along itself. No area goes with it, and what
  // would lie beside it if it stayed is no inside.
  bool is_tip(std::size_t k) const {
    const Point &a = point(before(k)), &b = point(k), &c = point(after(k));
    return turn(k) == CGAL::COLLINEAR && !CGAL::collinear_are_ordered_along_line(a, b, c);
  }

  // Tells whether the triangle at a corner has some area, no other corner in it or on it, but for those in
  // its own corners, and whether its third side crosses no other side of the polygon.
  bool is_ear(std::size_t k) const {
    if (turn(k) != CGAL::LEFT_TURN) return false;
    const Point &a = point(before(k)), &b = point(k), &c = point(after(k));
    for (std::size_t i = 0; i < left_.size(); ++i) {
      const Point &p = point(i), &q = point(after(i));
      if (p != a && p != b && p != c && CGAL::orientation(a, b, p) != CGAL::RIGHT_TURN &&
          CGAL::orientation(b, c, p) != CGAL::RIGHT_TURN && CGAL::orientation(c, a, p) != CGAL::RIGHT_TURN)
        return false;
      if (CGAL::orientation(a, c, p) * CGAL::orientation(a, c, q) < 0 &&
          CGAL::orientation(p, q, a) * CGAL::orientation(p, q, c) < 0)
        return false;
    }
    return true;
  }

  std::vector<Point> points_;
  std::vector<std::size_t> left_;  // corners that have not been cut off, in the order of the loop
};

}  // namespace

std::vector<std::array<std::size_t, 3>> clipped_ears(std::span<const Vec3> loop, const Vec3& normal) {
  if (loop.size() < 3 || loop.size() > kMostCorners || normal.isZero(0)) return {};
  return EarClipper(seen_along(normal, loop)).clip();
}

}  // namespace cscd::scenes
