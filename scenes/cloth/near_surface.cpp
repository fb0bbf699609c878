#include "scenes/cloth/near_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cscd::scenes {
namespace {

// Cells are this many reaches wide, unless that would make more than kMostCells.
constexpr double kCellWidth = 1.5;
constexpr double kMostCells = 1 << 18;

// The barycentric weights of the triangle's point that is nearest to p (Ericson, "Real-time collision
// detection", 2005, section 5.1.5).
Vec3 nearest_weights(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a, ap = p - a;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return {1, 0, 0};
  const Vec3 bp = p - b;
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return {0, 1, 0};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return {1 - d1 / (d1 - d3), d1 / (d1 - d3), 0};
  const Vec3 cp = p - c;
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return {0, 0, 1};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return {1 - d2 / (d2 - d6), 0, d2 / (d2 - d6)};
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 >= d3 && d5 >= d6) {
    const double share = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return {0, 1 - share, share};
  }
  return Vec3(va, vb, vc) / (va + vb + vc);
}

Vec3 weighted(const Vec3& weights, const Triangle& corners, const std::vector<Vec3>& values) {
  return weights[0] * values[+corners[0]] + weights[1] * values[+corners[1]] +
         weights[2] * values[+corners[2]];
}

}  // namespace

NearSurface::Cells NearSurface::cells_of(const Box& box) const {
  const auto cell = [&](const Vec3& point) {
    return ((point - low_) / cell_).array().floor().cast<int>().max(0).min(count_ - 1).eval();
  };
  return {cell(box.low), cell(box.high)};
}

std::size_t NearSurface::cell_at(const Eigen::Array3i& place) const {
  return static_cast<std::size_t>((place.z() * count_.y() + place.y()) * count_.x() + place.x());
}

void NearSurface::place(std::span<const Vec3> positions, const Vec3& low, const Vec3& high, double reach) {
  positions_.assign(positions.begin(), positions.end());
  reach_ = reach;
  low_ = low;
  high_ = high;
  const Vec3 extent = (high - low).cwiseMax(reach);
  cell_ = std::max(kCellWidth * reach, std::cbrt(extent.prod() / kMostCells));
  count_ = (extent / cell_).array().floor().cast<int>() + 1;

  normals_.assign(positions.size(), Vec3::Zero());
  boxes_.clear();
  for (std::size_t t = 0; t < mesh_.triangle_count(); ++t) {
    const TriangleId triangle{static_cast<int>(t)};
    const auto& [a, b, c] = mesh_.corners(triangle);
    const Vec3 &at_a = positions[+a], &at_b = positions[+b], &at_c = positions[+c];
    const Box box{(at_a.cwiseMin(at_b).cwiseMin(at_c).array() - reach).matrix(),
                  (at_a.cwiseMax(at_b).cwiseMax(at_c).array() + reach).matrix()};
    if ((box.low.array() > high.array()).any() || (box.high.array() < low.array()).any()) continue;
    boxes_.push_back({triangle, box});
    const Vec3 area = (at_b - at_a).cross(at_c - at_a);
    for (const VertexId corner : mesh_.corners(triangle)) normals_[+corner] += area;
  }

  const auto for_each_cell = [&](const Box& box, const auto& visit) {
    const Cells cells = cells_of(box);
    Eigen::Array3i at = cells.from;
    for (at.z() = cells.from.z(); at.z() <= cells.to.z(); ++at.z())
      for (at.y() = cells.from.y(); at.y() <= cells.to.y(); ++at.y())
        for (at.x() = cells.from.x(); at.x() <= cells.to.x(); ++at.x()) visit(cell_at(at));
  };
  first_.assign(static_cast<std::size_t>(count_.prod()) + 1, 0);
  for (const auto& [triangle, box] : boxes_)
    for_each_cell(box, [&](std::size_t cell) { ++first_[cell + 1]; });
  for (std::size_t cell = 1; cell < first_.size(); ++cell) first_[cell] += first_[cell - 1];
  in_cell_.resize(static_cast<std::size_t>(first_.back()));
  std::vector<int> next(first_.begin(), first_.end() - 1);
  for (std::size_t i = 0; i < boxes_.size(); ++i)
    for_each_cell(boxes_[i].second, [&](std::size_t cell) {
      in_cell_[static_cast<std::size_t>(next[cell]++)] = static_cast<int>(i);
    });
}

std::optional<NearSurface::Nearest> NearSurface::nearest(const Vec3& point) const {
  if (boxes_.empty() || (point.array() < low_.array()).any() || (point.array() > high_.array()).any())
    return std::nullopt;
  const std::size_t cell = cell_at(cells_of({point, point}).from);
  double least = reach_ * reach_;
  Nearest found{TriangleId{-1}, Vec3::Zero(), Vec3::Zero(), 0};
  for (int i = first_[cell]; i < first_[cell + 1]; ++i) {
    const auto& [triangle, box] = boxes_[static_cast<std::size_t>(in_cell_[static_cast<std::size_t>(i)])];
    if ((point.array() < box.low.array()).any() || (point.array() > box.high.array()).any()) continue;
    const Triangle& corners = mesh_.corners(triangle);
    const Vec3 weights =
        nearest_weights(point, positions_[+corners[0]], positions_[+corners[1]], positions_[+corners[2]]);
    const double squared = (point - weighted(weights, corners, positions_)).squaredNorm();
    if (squared >= least) continue;
    least = squared;
    found.triangle = triangle;
    found.weights = weights;
  }
  if (found.triangle == TriangleId{-1}) return std::nullopt;
  // The interpolated normal tells the side, also where the nearest point lies on an edge or a vertex. On the
  // surface itself it is the way out.
  const Triangle& corners = mesh_.corners(found.triangle);
  const Vec3 normal = weighted(found.weights, corners, normals_);
  const Vec3 from = point - weighted(found.weights, corners, positions_);
  const double distance = std::sqrt(least), length = normal.norm();
  const double side = from.dot(normal) < 0 ? -1 : 1;
  if (distance > 1e-6 * reach_)
    found.outward = side / distance * from;
  else if (length > 0)
    found.outward = normal / length;
  else
    return std::nullopt;
  found.distance = side * distance;
  return found;
}

}  // namespace cscd::scenes
