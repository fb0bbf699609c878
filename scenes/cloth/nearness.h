#pragma once

#include <cstdint>
#include <optional>
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

// Finds the point of a closed surface that is nearest to a given point, by a grid of cells.
class NearSurface {
 public:
  // The mesh must outlive the object.
  explicit NearSurface(const TriangleMesh& mesh) : mesh_(mesh) {}

  // Takes the surface's positions [vertices], and prepares for questions about points that lie between the
  // corners `low` and `high` and no further than `reach` from the surface.
  void place(std::span<const Vec3> positions, const Vec3& low, const Vec3& high, double reach);

  struct Nearest {
    TriangleId triangle;
    Vec3 weights;     // barycentric, of the nearest point
    Vec3 outward;     // the direction, of length 1, in which the surface is left fastest
    double distance;  // negative inside
  };
  // Returns nullopt for a point that is further than the reach from the surface.
  std::optional<Nearest> nearest(const Vec3& point) const;

  const TriangleMesh& mesh() const { return mesh_; }

 private:
  struct Box {
    Vec3 low, high;
  };
  // The cells from `from` to `to`, both included, that a box overlaps.
  struct Cells {
    Eigen::Array3i from, to;
  };
  Cells cells_of(const Box& box) const;
  std::size_t cell_at(const Eigen::Array3i& place) const;

  const TriangleMesh& mesh_;
  std::vector<Vec3> positions_;  // [vertices]
  std::vector<Vec3> normals_;    // [vertices]: sums of the area vectors of the triangles round a vertex
  double reach_ = 0, cell_ = 1;
  Vec3 low_ = Vec3::Zero(), high_ = Vec3::Zero();
  Eigen::Array3i count_{0, 0, 0};  // cells along each axis
  std::vector<std::pair<TriangleId, Box>>
      boxes_;                 // of the triangles that questions can reach, with the reach
  std::vector<int> first_;    // [cells + 1]: where the boxes of a cell begin in in_cell_
  std::vector<int> in_cell_;  // places in boxes_
};

}  // namespace cscd::scenes
