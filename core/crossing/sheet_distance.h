#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "core/geometry/nearest_points.h"
#include "core/mesh/triangle_mesh.h"

namespace cscd {

// Distances of points to some triangles in one pose, up to rounding.
class SheetDistance {
 public:
  SheetDistance(const TriangleMesh& mesh, std::span<const Vec3> positions,
                std::span<const TriangleId> triangles)
      : mesh_(mesh), positions_(positions) {
    items_.reserve(triangles.size());
    for (const TriangleId t : triangles) {
      const Triangle& c = mesh.corners(t);
      const Vec3 &x = positions[+c[0]], &y = positions[+c[1]], &z = positions[+c[2]];
      items_.push_back({x.cwiseMin(y).cwiseMin(z), x.cwiseMax(y).cwiseMax(z), t});
    }
    for (std::size_t first = 0; first < items_.size(); first += kBlock) {
      Box box = {items_[first].low, items_[first].high};
      for (std::size_t i = first + 1; i < std::min(first + kBlock, items_.size()); ++i) {
        box.low = box.low.cwiseMin(items_[i].low);
        box.high = box.high.cwiseMax(items_[i].high);
      }
      blocks_.push_back(box);
    }
  }

  struct Nearest {
    double distance;
    TriangleId triangle;
  };
  // The nearest triangle to a point. The search ends early once some triangle is as near as `enough`: the
  // answer is then any such triangle. There must be a triangle.
  Nearest nearest(const Vec3& point, double enough) const {
    double least = std::numeric_limits<double>::infinity();
    std::size_t found = 0;
    const auto look = [&](std::size_t i) {
      const double squared = squared_distance(point, items_[i].triangle);
      if (squared < least) least = squared, found = i;
    };
    look(hint_);
    const double enough_squared = enough * enough;
    for (std::size_t b = 0; b < blocks_.size() && least > enough_squared; ++b) {
      if (squared_to_box(point, blocks_[b].low, blocks_[b].high) >= least) continue;
      for (std::size_t i = b * kBlock; i < std::min((b + 1) * kBlock, items_.size()); ++i)
        if (squared_to_box(point, items_[i].low, items_[i].high) < least) look(i);
    }
    hint_ = found;
    return {std::sqrt(least), items_[found].triangle};
  }

 private:
  static constexpr std::size_t kBlock = 8;
  struct Box {
    Vec3 low, high;
  };
  struct Item {
    Vec3 low, high;
    TriangleId triangle;
  };

  static double squared_to_box(const Vec3& p, const Vec3& low, const Vec3& high) {
    return (low - p).cwiseMax(p - high).cwiseMax(0).squaredNorm();
  }
  double squared_distance(const Vec3& p, TriangleId t) const {
    const Triangle& c = mesh_.corners(t);
    return nearest_of_vertex_face({p, positions_[+c[0]], positions_[+c[1]], positions_[+c[2]]})
        .way.squaredNorm();
  }

  const TriangleMesh& mesh_;
  std::span<const Vec3> positions_;
  std::vector<Item> items_;
  std::vector<Box> blocks_;       // of kBlock triangles each
  mutable std::size_t hint_ = 0;  // the triangle that was nearest to the last point
};

}  // namespace cscd
