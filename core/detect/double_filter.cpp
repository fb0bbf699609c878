#include "core/detect/filter_block.h"
#include "core/geometry/sideways.h"
#include "core/geometry/triple_product_lanes.h"

// The result is, bit for bit, that of the scalar functions for each pair. Turning an edge round or exchanging
// two edges changes the sign of exact differences, and so the sign of a whole cubic, but no rounding. The
// point from which the other points are seen does affect rounding. So an edge is seen from its first end,
// which has the smaller index. For two edges the points are seen from the first end of the first edge, which
// is the edge whose first end has the smaller index.
namespace cscd {
namespace {

// The corners of two triangles and their edges, one a lane: lanes 0 to 2 belong to the first triangle, lanes
// 3 to 5 to the second; the last two lanes are spare. Edge l runs from corner l to the next one.
struct Features {
  VectorLanes corner;
  VectorLanes first_end, other_end;  // of edges
  Sign8 first;                       // index of the edge's first end
  VectorLanes edge;
  Lane8 longest;  // largest component of each edge
};

// Lane l of the result is lane kFrom[l] of `v`, or lane kFrom[l] - 8 of `w`.
template <int... kFrom>
VectorLanes picked(const VectorLanes& v, const VectorLanes& w) {
  VectorLanes out;
  for (int end = 0; end < 2; ++end)
    for (int i = 0; i < 3; ++i) out.at[end][i] = shuffled<kFrom...>(v.at[end][i], w.at[end][i]);
  return out;
}
template <int... kFrom>
VectorLanes picked(const VectorLanes& v) {
  return picked<kFrom...>(v, v);
}
template <int... kFrom, class Lanes>
Lanes picked(Lanes v) {
  return shuffled<kFrom...>(v, v);
}

VectorLanes chosen(Sign8 which, const VectorLanes& v, const VectorLanes& w) {
  VectorLanes out;
  for (int end = 0; end < 2; ++end)
    for (int i = 0; i < 3; ++i) out.at[end][i] = select(which, v.at[end][i], w.at[end][i]);
  return out;
}

Features features_of(const Motion& motion, const Triangle& a, const Triangle& b) {
  VertexLanes vertices;
  Sign8 number{};
  for (std::size_t l = 0; l < kLanes; ++l) {
    const VertexId v = l < 3 ? a[l] : b[l < 6 ? l - 3 : 2];
    vertices.set(l, v);
    number[l] = static_cast<std::int32_t>(v);
  }
  Features f;
  f.corner = gather(motion, vertices);
  const VectorLanes next = picked<1, 2, 0, 4, 5, 3, 6, 7>(f.corner);
  const Sign8 next_number = picked<1, 2, 0, 4, 5, 3, 6, 7>(number), forward = number < next_number;
  f.first_end = chosen(forward, f.corner, next);
  f.other_end = chosen(forward, next, f.corner);
  f.first = select(forward, number, next_number);
  f.edge = next - f.corner;
  f.longest = f.edge.largest_component();
  return f;
}

// The four points of each of eight feature pairs, as apart_sideways() takes them.
struct Points {
  VectorLanes of_first[2], of_second[2];  // two edges; or a face's corners and a vertex
};

// These functions choose, from any per-edge lanes, the first and the second edge of the pairs at eight
// places. Low: places 0 to 5, a vertex and a face, represented by the two edges at the first corner of the
// face; then places 6 and 7, edge 0 of the first triangle with edges 0 and 1 of the second. High: places 8 to
// 14, all other pairs of edges, and the last place once more.
constexpr auto kLowFirst = [](const auto& edges) { return picked<3, 3, 3, 0, 0, 0, 0, 0>(edges); };
constexpr auto kLowSecond = [](const auto& edges) { return picked<5, 5, 5, 2, 2, 2, 3, 4>(edges); };
constexpr auto kHighFirst = [](const auto& edges) { return picked<0, 1, 1, 1, 2, 2, 2, 2>(edges); };
constexpr auto kHighSecond = [](const auto& edges) { return picked<5, 3, 4, 5, 3, 4, 5, 5>(edges); };
constexpr Sign8 kLowVertexFace = {-1, -1, -1, -1, -1, -1, 0, 0};

Points low_points(const Features& f) {
  return {{picked<3, 3, 3, 0, 0, 0, 8 + 0, 8 + 0>(f.corner, f.first_end),
           picked<4, 4, 4, 1, 1, 1, 8 + 0, 8 + 0>(f.corner, f.other_end)},
          {picked<5, 5, 5, 2, 2, 2, 8 + 3, 8 + 4>(f.corner, f.first_end),
           picked<0, 1, 2, 3, 4, 5, 8 + 3, 8 + 4>(f.corner, f.other_end)}};
}
Points high_points(const Features& f) {
  return {{kHighFirst(f.first_end), kHighFirst(f.other_end)},
          {kHighSecond(f.first_end), kHighSecond(f.other_end)}};
}

template <class First, class Second>
unsigned never_coplanar(const Features& f, const First& first, const Second& second,
                        const VectorLanes& third) {
  return bits_of(
      certain_signs(cross(first(f.edge), second(f.edge), first(f.longest) * second(f.longest)), third));
}

// Returns one bit for each of eight pairs: 1 if they certainly stay apart in their plane. `exchanged` marks
// pairs of edges whose second edge is to be taken as the first.
unsigned apart_in_plane(const Points& points, Sign8 exchanged, Sign8 vertex_face) {
  const auto& [one, two] = points;
  const VectorLanes from = chosen(exchanged, two[0], one[0]);
  const VectorLanes seen[3] = {chosen(exchanged, two[1], one[1]) - from,
                               chosen(exchanged, one[0], two[0]) - from,
                               chosen(exchanged, one[1], two[1]) - from};
  SeenFromFirst<Lane8> p;
  for (int k = 0; k < 3; ++k)
    for (int end = 0; end < 2; ++end)
      for (int i = 0; i < 3; ++i) p[k][end][i] = seen[k].at[end][i];
  return bits_of(apart_sideways(p, vertex_face));
}

}  // namespace

CarriedPlaces not_filtered(const Motion& motion, const Triangle& a, const Triangle& b, CarriedPlaces places) {
  const Features f = features_of(motion, a, b);
  const unsigned low = never_coplanar(f, kLowFirst, kLowSecond,
                                      picked<0, 1, 2, 3, 4, 5, 8 + 3, 8 + 4>(f.corner, f.first_end) -
                                          picked<3, 3, 3, 0, 0, 0, 8 + 0, 8 + 0>(f.corner, f.first_end));
  const unsigned high =
      never_coplanar(f, kHighFirst, kHighSecond, kHighSecond(f.first_end) - kHighFirst(f.first_end));
  unsigned left = places & ~(low | high << 8);
  if ((left & 0xff) != 0) {
    const Sign8 exchanged = (kLowFirst(f.first) > kLowSecond(f.first)) & ~kLowVertexFace;
    left &= ~apart_in_plane(low_points(f), exchanged, kLowVertexFace);
  }
  if (left >> 8 != 0) {
    const Sign8 exchanged = kHighFirst(f.first) > kHighSecond(f.first);
    left &= ~(apart_in_plane(high_points(f), exchanged, Sign8{}) << 8);
  }
  return static_cast<CarriedPlaces>(left);
}

}  // namespace cscd
