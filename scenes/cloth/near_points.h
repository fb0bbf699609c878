#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "core/mesh/triangle_mesh.h"

namespace cscd::scenes {

// Finds the pairs of a surface's vertices that are close in space and share no edge, by a hash grid.
class NearPoints {
 public:
  explicit NearPoints(const TriangleMesh& mesh);

  // Returns all pairs of vertices that share no edge and are at most `reach` apart, each once. The order
  // depends on the points [vertices] alone. The view is valid until the next call.
  std::span<const std::pair<int, int>> find(std::span<const Vec3> points, double reach);

 private:
  struct Entry {  // a point and its cell
    std::int32_t x, y, z;
    int point;
    bool same_cell(const Entry& other) const { return x == other.x && y == other.y && z == other.z; }
  };
  std::size_t bucket(std::int32_t x, std::int32_t y, std::int32_t z) const;
  void sort_into_buckets(std::span<const Vec3> points, double reach);
  bool share_edge(int a, int b) const;

  std::vector<int> first_neighbour_, neighbour_;  // of vertex v: neighbour_[first[v] .. first[v + 1])
  std::vector<Entry> entries_, sorted_;           // [vertices]; sorted_ is in the order of buckets
  std::vector<int> first_in_bucket_;              // [buckets + 1]
  std::vector<std::pair<int, int>> pairs_;
};

}  // namespace cscd::scenes
