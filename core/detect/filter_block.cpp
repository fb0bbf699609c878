#include "core/detect/filter_block.h"

#include <algorithm>
#include <array>
#include <optional>

#include "core/elementary/question/filter.h"
#include "core/geometry/sideways.h"
#include "core/geometry/triple_product_lanes.h"

namespace cscd {
namespace {

// The vertices between which the three vectors of eight coplanarity cubics run, as in
// core/elementary/question/filter.h. The first and the third vector start at the same vertex.
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

// The four points of eight feature pairs, as apart_sideways() takes them.
struct PointLanes {
  VertexLanes from, to[3];
  Sign8 vertex_face;

  void set(std::size_t lane, const TriangleMesh& mesh, const FeaturePair& pair) {
    vertex_face[lane] = pair.kind == FeaturePair::Kind::vertex_face ? -1 : 0;
    if (vertex_face[lane]) {
      const auto [p, q, r] = mesh.corners(TriangleId{pair.b});
      from.set(lane, p), to[0].set(lane, q), to[1].set(lane, r), to[2].set(lane, VertexId{pair.a});
    } else {
      const auto [p, q] = mesh.ends(EdgeId{pair.a});
      const auto [r, s] = mesh.ends(EdgeId{pair.b});
      from.set(lane, p), to[0].set(lane, q), to[1].set(lane, r), to[2].set(lane, s);
    }
  }
  Sign8 apart(const Motion& motion) const {
    const VectorLanes origin = gather(motion, from);
    SeenFromFirst<Lane8> p;
    for (std::size_t k = 0; k < 3; ++k) {
      const VectorLanes seen = gather(motion, to[k]) - origin;
      std::copy(&seen.at[0][0], &seen.at[0][0] + 6, &p[k][0][0]);
    }
    return apart_sideways(p, vertex_face);
  }
};

// Asks `dropped` about eight feature pairs at a time, and calls keep(pair) for
// every pair for which it says 0.
template <class Lanes, class Dropped, class Keep>
void for_each_left(const TriangleMesh& mesh, std::span<const FeaturePair> pairs, const Dropped& dropped,
                   const Keep& keep) {
  Lanes lanes;
  for (std::size_t first = 0; first < pairs.size(); first += kLanes) {
    const std::size_t count = std::min(kLanes, pairs.size() - first);
    for (std::size_t l = 0; l < kLanes; ++l) lanes.set(l, mesh, pairs[first + std::min(l, count - 1)]);
    const Sign8 drop = dropped(lanes);
    for (std::size_t l = 0; l < count; ++l)
      if (drop[l] == 0) keep(pairs[first + l]);
  }
}

}  // namespace

void filter(const TriangleMesh& mesh, const Motion& motion, std::span<const FeaturePair> pairs,
            std::vector<FeaturePair>& left) {
  const std::size_t before = left.size();
  for_each_left<CubicLanes>(
      mesh, pairs, [&](const CubicLanes& cubics) { return cubics.signs(motion); },
      [&](const FeaturePair& pair) { left.push_back(pair); });
  std::size_t kept = before;
  for_each_left<PointLanes>(
      mesh, std::span(left).subspan(before), [&](const PointLanes& points) { return points.apart(motion); },
      [&](const FeaturePair& pair) { left[kept++] = pair; });
  left.resize(kept);
}

void filter(const TriangleMesh& mesh, const Motion& motion, std::span<const CarriedPairs> pairs,
            bool single_precision_first, double last, std::vector<FeaturePair>& left) {
  // Filter many triangle pairs first, and append their feature pairs afterwards. A branch on the result of
  // one triangle pair would make the next one wait.
  constexpr std::size_t kTogether = 64;
  for (; !pairs.empty(); pairs = pairs.subspan(std::min(kTogether, pairs.size()))) {
    std::array<CarriedPairs, kTogether> rest;
    std::size_t count = 0;
    for (const auto& [pair, places] : pairs.first(std::min(kTogether, pairs.size()))) {
      const Triangle &a = mesh.corners(pair.a), &b = mesh.corners(pair.b);
      rest[count++] = {pair, single_precision_first ? not_filtered_when_coplanar(motion, a, b, places, last)
                                                    : not_filtered(motion, a, b, places)};
    }
    for (std::size_t i = 0; i < count; ++i)
      for_each_carried(mesh, rest[i], [&](const FeaturePair& features) { left.push_back(features); });
  }
}

}  // namespace cscd
