#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/mesh/adjacency.h"

namespace cscd {

// For each triangle, those that share a vertex with it or with a triangle that does. If some triangle has a
// vertex of two features, any two triangles that have these features are near in this sense.
class NearTriangles {
 public:
  explicit NearTriangles(const TriangleMesh& mesh) : offset_(1, 0) {
    std::vector<std::int32_t> seen(mesh.triangle_count(), -1);
    for (std::size_t t = 0; t < seen.size(); ++t) {
      const auto stamp = static_cast<std::int32_t>(t);
      seen[t] = stamp;
      const auto take = [&](TriangleId b) {
        if (seen[+b] != stamp) near_.push_back(b);
        seen[+b] = stamp;
      };
      const std::size_t first = near_.size();
      for_each_neighbour(mesh, TriangleId{stamp}, take);
      for (std::size_t i = first, end = near_.size(); i < end; ++i) for_each_neighbour(mesh, near_[i], take);
      offset_.push_back(static_cast<std::int32_t>(near_.size()));
    }
  }

  std::span<const TriangleId> of(TriangleId t) const {
    const auto first = static_cast<std::size_t>(offset_[+t]);
    return std::span(near_).subspan(first, static_cast<std::size_t>(offset_[+t + 1]) - first);
  }

 private:
  std::vector<std::int32_t> offset_;  // [triangles + 1]
  std::vector<TriangleId> near_;
};

}  // namespace cscd
