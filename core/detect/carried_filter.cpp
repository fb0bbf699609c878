#include "core/detect/carried_filter.h"

#include "core/geometry/sideways.h"
#include "core/geometry/triple_product_lanes.h"

// Bit for bit what the scalar twins say of each pair. To turn an edge round or to exchange two edges changes
// the sign of exact differences, and so that of a whole cubic, but no rounding; from which end the other
// points are seen does. So that is the edge's first end, which has the smaller index; and of two edges that
// of the first, which is the one with the smaller first end.
namespace cscd {
namespace {

// Lanes: the corners of the first triangle, or its edges, those of the second, two to spare.
struct Features {
  VectorLanes corner;
  VectorLanes first_end, other_end;  // of edges
  Sign8 first;                       // number of the vertex
  VectorLanes edge;
  Lane8 longest;  // component of each edge
};

// Of `v`, and from 8 on of `w`.
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

// Four points of each of eight pairs, as the filter takes them.
struct Points {
  VectorLanes of_first[2], of_second[2];  // edges, or the face but its third corner, and that and the vertex
};

// Which edges are the first and the second of the pairs at eight places, of whatever is known of edges.
// Places 0 to 7: what vertices carry, with the edges at the first corner of their face; edge 0 of the first
// triangle with edges 0 and 1 of the second. Places 8 to 14, and the last again: the other edges.
constexpr auto kLowFirst = [](const auto& edges) { return picked<3, 3, 3, 0, 0, 0, 0, 0>(edges); };
constexpr auto kLowSecond = [](const auto& edges) { return picked<5, 5, 5, 2, 2, 2, 3, 4>(edges); };
constexpr auto kHighFirst = [](const auto& edges) { return picked<0, 1, 1, 1, 2, 2, 2, 2>(edges); };
constexpr auto kHighSecond = [](const auto& edges) { return picked<5, 3, 4, 5, 3, 4, 5, 5>(edges); };
constexpr Sign8 kVertexFace = {-1, -1, -1, -1, -1, -1, 0, 0};  // at places 0 to 7

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

// `exchanged`: where the second edge comes first.
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
    const Sign8 exchanged = (kLowFirst(f.first) > kLowSecond(f.first)) & ~kVertexFace;
    left &= ~apart_in_plane(low_points(f), exchanged, kVertexFace);
  }
  if (left >> 8 != 0) {
    const Sign8 exchanged = kHighFirst(f.first) > kHighSecond(f.first);
    left &= ~(apart_in_plane(high_points(f), exchanged, Sign8{}) << 8);
  }
  return static_cast<CarriedPlaces>(left);
}

}  // namespace cscd
