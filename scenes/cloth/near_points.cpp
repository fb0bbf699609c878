#include "scenes/cloth/near_points.h"

#include <algorithm>
#include <bit>
#include <cmath>

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

}  // namespace cscd::scenes
