#include "scenes/cloth/nearness.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace cscd::scenes {

NearPoints::NearPoints(const TriangleMesh& mesh)
    : first_neighbour_(mesh.vertex_count() + 1),
      neighbour_(2 * mesh.edge_count()),
      entries_(mesh.vertex_count()),
      sorted_(mesh.vertex_count()),
      first_in_bucket_(std::bit_ceil(mesh.vertex_count()) + 1) {
  for (const Edge& edge : mesh.edges())
    for (const VertexId end : edge) ++first_neighbour_[+end];
  int sum = 0;
  for (int& offset : first_neighbour_) offset = (sum += offset);
  for (const Edge& edge : mesh.edges()) {
    neighbour_[static_cast<std::size_t>(--first_neighbour_[+edge[0]])] = static_cast<int>(edge[1]);
    neighbour_[static_cast<std::size_t>(--first_neighbour_[+edge[1]])] = static_cast<int>(edge[0]);
  }
}

// Cells that follow each other along x lie in buckets that follow each other.
std::size_t NearPoints::bucket(std::int32_t x, std::int32_t y, std::int32_t z) const {
  const std::uint32_t mixed = static_cast<std::uint32_t>(x) + static_cast<std::uint32_t>(y) * 0x9e3779b1u +
                              static_cast<std::uint32_t>(z) * 0x85ebca77u;
  return mixed & (first_in_bucket_.size() - 2);
}

void NearPoints::sort_into_buckets(std::span<const Vec3> points, double reach) {
  std::ranges::fill(first_in_bucket_, 0);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto cell = [&](double coordinate) {
      return static_cast<std::int32_t>(std::clamp(std::floor(coordinate / reach), -1e9, 1e9));
    };
    entries_[i] = {cell(points[i].x()), cell(points[i].y()), cell(points[i].z()), static_cast<int>(i)};
    ++first_in_bucket_[bucket(entries_[i].x, entries_[i].y, entries_[i].z)];
  }
  int sum = 0;
  for (int& offset : first_in_bucket_) offset = (sum += offset);
  for (std::size_t i = points.size(); i-- > 0;) {
    const Entry& entry = entries_[i];
    sorted_[static_cast<std::size_t>(--first_in_bucket_[bucket(entry.x, entry.y, entry.z)])] = entry;
  }
}

bool NearPoints::share_edge(int a, int b) const {
  const auto first = static_cast<std::size_t>(first_neighbour_[static_cast<std::size_t>(a)]);
  const auto last = static_cast<std::size_t>(first_neighbour_[static_cast<std::size_t>(a) + 1]);
  for (std::size_t i = first; i < last; ++i)
    if (neighbour_[i] == b) return true;
  return false;
}

std::span<const std::pair<int, int>> NearPoints::find(std::span<const Vec3> points, double reach) {
  sort_into_buckets(points, reach);
  pairs_.clear();
  const double limit = reach * reach;
  const auto try_pair = [&](int a, int b) {
    const double distance =
        (points[static_cast<std::size_t>(a)] - points[static_cast<std::size_t>(b)]).squaredNorm();
    if (distance <= limit && !share_edge(a, b)) pairs_.push_back({a, b});
  };
  // A pair of two cells is found from the cell that lies first in the order of z, y, x.
  constexpr int kFollowing[13][3] = {{1, 0, 0},  {-1, 1, 0}, {0, 1, 0},  {1, 1, 0}, {-1, -1, 1},
                                     {0, -1, 1}, {1, -1, 1}, {-1, 0, 1}, {0, 0, 1}, {1, 0, 1},
                                     {-1, 1, 1}, {0, 1, 1},  {1, 1, 1}};
  for (std::size_t i = 0; i < sorted_.size(); ++i) {
    const Entry& entry = sorted_[i];
    const auto own_end = static_cast<std::size_t>(first_in_bucket_[bucket(entry.x, entry.y, entry.z) + 1]);
    for (std::size_t k = i + 1; k < own_end; ++k)
      if (sorted_[k].same_cell(entry)) try_pair(entry.point, sorted_[k].point);
    for (const auto& step : kFollowing) {
      const Entry wanted{entry.x + step[0], entry.y + step[1], entry.z + step[2], 0};
      const std::size_t at = bucket(wanted.x, wanted.y, wanted.z);
      const auto end = static_cast<std::size_t>(first_in_bucket_[at + 1]);
      for (auto k = static_cast<std::size_t>(first_in_bucket_[at]); k < end; ++k)
        if (sorted_[k].same_cell(wanted)) try_pair(entry.point, sorted_[k].point);
    }
  }
  return pairs_;
}

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
