#include "core/detect/filter_block.h"

#include <algorithm>

#include "core/elementary/filter.h"
#include "core/geometry/triple_product_lanes.h"

namespace cscd {
namespace {

// The vertices between which the three vectors of eight coplanarity cubics run, as in
// core/elementary/filter.h. The first and the third start at one vertex.
struct CubicLanes {
  VertexLanes origin, a_to, b_from, b_to, c_to;

  void set(std::size_t lane, const TriangleMesh& mesh, const FeaturePair& pair) {
    if (pair.kind == FeaturePair::Kind::vertex_face) {
      const auto [p, q, r] = mesh.corners(TriangleId{pair.b});
      set(lane, {p, q, p, r, VertexId{pair.a}});
    } else {
      const auto [p, q] = mesh.ends(EdgeId{pair.a});
      const auto [r, s] = mesh.ends(EdgeId{pair.b});
      set(lane, {p, q, r, s, r});
    }
  }
  Sign8 signs(const Motion& motion) const {
    const VectorLanes from = gather(motion, origin);
    const VectorLanes a = gather(motion, a_to) - from, b = gather(motion, b_to) - gather(motion, b_from);
    return certain_signs(cross(a, b), gather(motion, c_to) - from);
  }

 private:
  void set(std::size_t lane, const std::array<VertexId, 5>& v) {
    origin.set(lane, v[0]), a_to.set(lane, v[1]);
    b_from.set(lane, v[2]), b_to.set(lane, v[3]);
    c_to.set(lane, v[4]);
  }
};

}  // namespace

void filter(const TriangleMesh& mesh, const Motion& motion, std::span<const FeaturePair> pairs,
            std::vector<FeaturePair>& left) {
  CubicLanes cubics;
  for (std::size_t first = 0; first < pairs.size(); first += kLanes) {
    const std::size_t count = std::min(kLanes, pairs.size() - first);
    for (std::size_t l = 0; l < kLanes; ++l) cubics.set(l, mesh, pairs[first + std::min(l, count - 1)]);
    const Sign8 signs = cubics.signs(motion);
    for (std::size_t l = 0; l < count; ++l)
      if (signs[l] == 0) left.push_back(pairs[first + l]);
  }
}

void filter_by_plain_sign(const TriangleMesh& mesh, const Motion& motion, std::span<const FeaturePair> pairs,
                          std::vector<FeaturePair>& left) {
  for (const FeaturePair& pair : pairs) {
    BernsteinCubic f = pair.kind == FeaturePair::Kind::vertex_face
                           ? coplanarity(vertex_face(mesh, motion, VertexId{pair.a}, TriangleId{pair.b}))
                           : coplanarity(edge_edge(mesh, motion, EdgeId{pair.a}, EdgeId{pair.b}));
    f.error = 0;
    if (certain_sign(f) == 0) left.push_back(pair);
  }
}

}  // namespace cscd
