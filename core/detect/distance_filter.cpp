#include "core/detect/distance_filter.h"

#include <algorithm>
#include <array>

#include "core/base/rounding.h"
#include "core/geometry/triple_product16.h"

namespace cscd {
namespace {

using Vector16 = std::array<Float16, 3>;

Vector16 operator-(const Vector16& a, const Vector16& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
Float16 dot(const Vector16& a, const Vector16& b) {
  return product_plus(a[2], b[2], product_plus(a[1], b[1], a[0] * b[0]));
}
Vector16 cross(const Vector16& a, const Vector16& b) {
  Vector16 out;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    out[i] = product_minus(a[j], b[k], a[k] * b[j]);
  }
  return out;
}
// The part of `v` at right angles to `edge`, times the squared length of the edge.
Vector16 across(const Vector16& edge, const Vector16& v) {
  const Float16 length = dot(edge, edge), along = dot(edge, v);
  return {v[0] * length - edge[0] * along, v[1] * length - edge[1] * along, v[2] * length - edge[2] * along};
}

// Sixteen feature pairs of one kind by their four points, at each end as seen from the first point. The first
// kFirst points belong to the first feature.
template <std::size_t kFirst>
struct FourPoints {
  std::array<Vector16, 4> at[2];
  Float16 distance;  // not below the thickness
  Float16 reach{};   // the largest coordinate

  void set(std::size_t lane, const Motion& motion, const std::array<VertexId, 4>& vertex, double thickness) {
    const std::span<const Vec3> ends[2] = {motion.start(), motion.end()};
    for (std::size_t end = 0; end < 2; ++end)
      for (std::size_t p = 0; p < 4; ++p) {
        const Vec3 seen = ends[end][+vertex[p]] - ends[end][+vertex[0]];
        for (std::size_t i = 0; i < 3; ++i)
          at[end][p][i][lane] = static_cast<float>(seen[static_cast<Eigen::Index>(i)]);
      }
    distance[lane] = float_not_below(thickness);
  }
  void find_reach() {
    for (const auto& end : at)
      for (const Vector16& point : end)
        for (const Float16& coordinate : point) reach = larger_size(reach, coordinate);
  }
  // The points half-way, times two.
  std::array<Vector16, 4> half_way() const {
    std::array<Vector16, 4> out;
    for (std::size_t p = 0; p < 4; ++p)
      for (std::size_t i = 0; i < 3; ++i) out[p][i] = at[0][p][i] + at[1][p][i];
    return out;
  }

  // The lanes in which the features are farther apart along a direction, on one side at both ends. Once the
  // direction is divided by its largest component, gaps are off by less than 32 u M, as in
  // no_contact_before.cpp. A direction of 0 divides to no number, and then no comparison holds.
  Mask16 farther_along(Vector16 direction) const {
    const Float16 largest = larger_size(larger_size(direction[0], direction[1]), direction[2]);
    for (Float16& component : direction) component /= largest;
    constexpr float kTiny = 1e-30F, kHuge = 1e30F;
    const Float16 error = all_lanes(32 * 0x1p-24F) * reach;
    const Float16 least =
        product_plus(all_lanes(1 + 0x1p-20F) * square_root(dot(direction, direction)), distance, error);
    unsigned over = 0xffff, under = 0xffff;
    for (const auto& end : at) {
      Float16 low[2], high[2];
      for (std::size_t p = 0; p < 4; ++p) {
        const Float16 along = dot(direction, end[p]);
        const std::size_t side = p < kFirst ? 0 : 1;
        const bool begins = p == 0 || p == kFirst;
        low[side] = begins ? along : smaller(low[side], along);
        high[side] = begins ? along : larger(high[side], along);
      }
      over &= above(low[1] - high[0], least);
      under &= above(low[0] - high[1], least);
    }
    return static_cast<Mask16>((over | under) & above(error, all_lanes(kTiny)) & above(all_lanes(kHuge), error));
  }
};

// Nearest points of a vertex and a triangle lie on the triangle, on an edge, or at a corner.
Mask16 farther(const FourPoints<1>& points) {
  const auto [v, p, q, r] = points.half_way();
  const Vector16 a = q - p, b = r - q, c = p - r;
  const Vector16 from_p = v - p, from_q = v - q, from_r = v - r;
  unsigned out = points.farther_along(cross(a, b));
  out |= points.farther_along(across(a, from_p)) | points.farther_along(across(b, from_q)) |
         points.farther_along(across(c, from_r));
  out |= points.farther_along(from_p) | points.farther_along(from_q) | points.farther_along(from_r);
  return static_cast<Mask16>(out);
}

// Nearest points of two edges lie inside both, or at an end of one or of both.
Mask16 farther(const FourPoints<2>& points) {
  const auto [p, q, r, s] = points.half_way();
  const Vector16 e = q - p, f = s - r, pr = r - p, ps = s - p, qr = r - q, qs = s - q;
  unsigned out = points.farther_along(cross(e, f));
  out |= points.farther_along(across(e, pr)) | points.farther_along(across(e, ps)) |
         points.farther_along(across(f, pr)) | points.farther_along(across(f, qr));
  out |= points.farther_along(pr) | points.farther_along(ps) | points.farther_along(qr) |
         points.farther_along(qs);
  return static_cast<Mask16>(out);
}

std::array<VertexId, 4> vertices_of(const TriangleMesh& mesh, const FeaturePair& pair) {
  if (pair.kind == FeaturePair::Kind::vertex_face) {
    const auto [p, q, r] = mesh.corners(TriangleId{pair.b});
    return {VertexId{pair.a}, p, q, r};
  }
  const auto [p, q] = mesh.ends(EdgeId{pair.a});
  const auto [r, s] = mesh.ends(EdgeId{pair.b});
  return {p, q, r, s};
}

// Marks the pairs of one kind that are farther apart, sixteen at a time.
template <std::size_t kFirst>
void mark_farther(FeaturePair::Kind kind, const Thickness& thickness, const TriangleMesh& mesh,
                  const Motion& motion, std::span<FeaturePair> pairs, std::span<bool> drop) {
  std::array<std::size_t, kLanes16> number{};
  std::size_t count = 0;
  const auto ask = [&] {
    FourPoints<kFirst> points{};
    for (std::size_t l = 0; l < kLanes16; ++l) {
      const FeaturePair& pair = pairs[number[std::min(l, count - 1)]];
      points.set(l, motion, vertices_of(mesh, pair), thickness.of(mesh, pair));
    }
    points.find_reach();
    const Mask16 apart = farther(points);
    for (std::size_t l = 0; l < count; ++l) drop[number[l]] = apart >> l & 1;
    count = 0;
  };
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (pairs[i].kind != kind) continue;
    number[count++] = i;
    if (count == kLanes16) ask();
  }
  if (count > 0) ask();
}

}  // namespace

void drop_farther_than(const Thickness& thickness, const TriangleMesh& mesh, const Motion& motion,
                       std::vector<FeaturePair>& pairs) {
  constexpr std::size_t kTogether = 512;
  std::array<bool, kTogether> drop;
  std::size_t kept = 0;
  for (std::size_t first = 0; first < pairs.size(); first += kTogether) {
    const auto some = std::span(pairs).subspan(first, std::min(kTogether, pairs.size() - first));
    mark_farther<1>(FeaturePair::Kind::vertex_face, thickness, mesh, motion, some, drop);
    mark_farther<2>(FeaturePair::Kind::edge_edge, thickness, mesh, motion, some, drop);
    for (std::size_t i = 0; i < some.size(); ++i)
      if (!drop[i]) pairs[kept++] = some[i];
  }
  pairs.resize(kept);
}

}  // namespace cscd
