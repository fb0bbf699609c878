#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "core/geometry/nearest_points.h"
#include "core/mesh/triangle_mesh.h"

namespace cscd {

// Distances of points to some triangles in one pose, up to rounding.
class SheetDistance {
 public:
  SheetDistance(const TriangleMesh& mesh, std::span<const Vec3> positions,
                std::span<const TriangleId> triangles)
      : mesh_(mesh), positions_(positions), triangles_(triangles.begin(), triangles.end()), boxes_(1) {
    boxes_[0].reserve(triangles.size());
    for (const TriangleId t : triangles) {
      const Triangle& c = mesh.corners(t);
      const Vec3 &x = positions[+c[0]], &y = positions[+c[1]], &z = positions[+c[2]];
      boxes_[0].push_back({x.cwiseMin(y).cwiseMin(z), x.cwiseMax(y).cwiseMax(z)});
    }
    while (boxes_.back().size() > kBlock) {
      const std::vector<Box>& below = boxes_.back();
      std::vector<Box> blocks;
      for (std::size_t i = 0; i < below.size(); ++i) {
        if (i % kBlock == 0) blocks.push_back(below[i]);
        blocks.back().low = blocks.back().low.cwiseMin(below[i].low);
        blocks.back().high = blocks.back().high.cwiseMax(below[i].high);
      }
      boxes_.push_back(std::move(blocks));
    }
  }

  struct Nearest {
    double distance;
    TriangleId triangle;
  };
  // The nearest triangle to a point. The search ends early once some triangle is as near as `enough`: the
  // answer is then any such triangle. There must be a triangle.
  Nearest nearest(const Vec3& point, double enough) const {
    Search search{point, enough * enough, squared_distance(point, triangles_[hint_]), hint_};
    look(boxes_.size() - 1, 0, search);
    hint_ = search.found;
    return {std::sqrt(search.least), triangles_[search.found]};
  }
  // Forgets the triangle that was nearest to the last point, with which a search begins.
  void start_anew() { hint_ = 0; }

 private:
  static constexpr std::size_t kBlock = 8;
  struct Box {
    Vec3 low, high;
  };
  struct Search {
    const Vec3& point;
    double enough, least;  // squared
    std::size_t found;
  };

  // Looks at a block of boxes of one level, and at what these hold, in the order of the triangles.
  void look(std::size_t level, std::size_t block, Search& search) const {
    const std::vector<Box>& boxes = boxes_[level];
    for (std::size_t i = block * kBlock; i < std::min((block + 1) * kBlock, boxes.size()); ++i) {
      if (search.least <= search.enough) return;
      if (squared_to_box(search.point, boxes[i].low, boxes[i].high) >= search.least) continue;
      if (level > 0) {
        look(level - 1, i, search);
      } else if (const double squared = squared_distance(search.point, triangles_[i]);
                 squared < search.least) {
        search.least = squared;
        search.found = i;
      }
    }
  }

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
  std::vector<TriangleId> triangles_;
  std::vector<std::vector<Box>> boxes_;  // of triangles, and above them of kBlock boxes each
  mutable std::size_t hint_ = 0;         // the triangle that was nearest to the last point
};

}  // namespace cscd
