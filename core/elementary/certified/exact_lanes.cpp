#include "core/elementary/certified/exact_lanes.h"

#include <algorithm>

#include "core/elementary/certified/contact_time.h"
#include "core/elementary/certified/doubles_stage.h"
#include "core/geometry/triple_product_lanes.h"

namespace cscd {
namespace {

constexpr int kSteps = 12;  // the most steps of Newton's iteration; nearly all queries need four or five

// Loads the queries into lanes. Lanes without a query hold the last query again.
template <class Query>
TriplePoints<VectorLanes> load(std::span<const Query> queries) {
  TriplePoints<VectorLanes> out;
  for (std::size_t l = 0; l < kLanes; ++l) {
    const auto points = triple_points(queries[std::min(l, queries.size() - 1)]);
    const auto set = [l](VectorLanes& lanes, const MovingPoint& p) {
      for (int i = 0; i < 3; ++i) lanes.at[0][i][l] = p.start[i], lanes.at[1][i][l] = p.end[i];
    };
    set(out.from, points.from), set(out.p_to, points.p_to), set(out.q_from, points.q_from);
    set(out.q_to, points.q_to), set(out.r_to, points.r_to);
  }
  return out;
}

VectorLanes between(const VectorLanes& x, Lane8 low, Lane8 high) {
  VectorLanes out;
  for (int i = 0; i < 3; ++i) {
    out.at[0][i] = (1 - low) * x.at[0][i] + low * x.at[1][i];
    out.at[1][i] = (1 - high) * x.at[0][i] + high * x.at[1][i];
  }
  return out;
}

// The lanes in which the cubic falls from certainly positive to certainly negative through its only root in
// [0, 1], by Descartes' rule as in doubles_stage.h.
Sign8 falls_once(const CubicOf<Lane8>& cubic) {
  const Lane8(&c)[4] = cubic.f.c, e = cubic.error;
  return (c[0] > e) & (c[3] < -e) & ((c[1] > e) | (c[2] < -e));
}

struct Enclosure {
  Lane8 low, high;
  Sign8 certain;  // the root is certainly between `low` and `high`
};
// Encloses the only root of each falling cubic in the lanes `which`.
Enclosure enclosed(const CubicOf<Lane8>& cubic, Sign8 which) {
  Lane8 low = {}, high = low + 1, t = cubic.f.c[0] / (cubic.f.c[0] - cubic.f.c[3]), value, slope;
  for (int step = 0;; ++step) {
    value = cubic.at(t), slope = cubic.slope(t);
    const Sign8 found = absolute(value) <= 4 * cubic.error;
    if (step == kSteps || bits_of(which & ~found) == 0) break;
    low = select(value > 0, t, low), high = select(value > 0, high, t);
    const Lane8 next = t - value / slope;
    const Sign8 inside = (next > low) & (next < high);
    const Lane8 better = select(inside, next, 0.5 * (low + high));
    t = select(found, t, better);
  }
  const Lane8 reach = 2 * (absolute(value) + cubic.error) / absolute(slope) + 0x1p-52;
  low = larger(t - reach, Lane8{}), high = smaller(t + reach, Lane8{} + 1);
  return {low, high, (cubic.at(low) > cubic.error) & (cubic.at(high) < -cubic.error)};
}

// The axis along which each lane looks at its plane.
struct Axis {
  Sign8 x, y;  // in all other lanes the axis is z

  // Chooses the axis along which p x q has its largest component at the start.
  Axis(const VectorLanes& p, const VectorLanes& q) {
    Lane8 size[3];
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3, k = (i + 2) % 3;
      size[i] = absolute(p.at[0][j] * q.at[0][k] - p.at[0][k] * q.at[0][j]);
    }
    x = (size[0] >= size[1]) & (size[0] >= size[2]);
    y = ~x & (size[1] >= size[2]);
  }
  SeenAlong<Lane8> seen(const VectorLanes& v) const {
    SeenAlong<Lane8> out;
    for (int end = 0; end < 2; ++end) {
      const Lane8(&c)[3] = v.at[end];
      out.at[end][0] = select(x, c[1], select(y, c[2], c[0]));
      out.at[end][1] = select(x, c[2], select(y, c[0], c[1]));
    }
    return out;
  }
};

template <class Query>
LaneAnswers decide(std::span<const Query> queries) {
  const TriplePoints<VectorLanes> points = load(queries);
  const VectorLanes p = points.p_to - points.from, q = points.q_to - points.q_from,
                    r = points.r_to - points.from;
  const BernsteinLanes f = triple_products(cross(p, q), r);
  const Sign8 never_coplanar = certain_sign(f);
  const CubicOf<Lane8> cubic(f, ProvenBounds::cubic);
  CubicOf<Lane8> falling = cubic;
  for (Lane8& c : falling.f.c) c = select(f.c[0] < 0, -c, c);
  const Sign8 once = falls_once(falling);
  const Enclosure root = enclosed(falling, once);

  const VectorLanes part_p = between(p, root.low, root.high), part_q = between(q, root.low, root.high),
                    part_r = between(r, root.low, root.high);
  const Sizes<Lane8> size{p.largest_component(), q.largest_component(), r.largest_component()};
  const Axis axis(part_p, part_q);
  const Place<Lane8> place =
      place_along<Query, ProvenBounds>(axis.seen(part_p), axis.seen(part_q), axis.seen(part_r), size);
  const CertainTime<Lane8> time = time_in_pairs(points, size, cubic, root.low, root.high);

  const Sign8 met = once & root.certain, contact = met & place.inside & time.known;
  LaneAnswers out;
  out.decided = bits_of(never_coplanar | (met & place.outside) | contact);
  for (std::size_t l = 0; l < kLanes; ++l)
    out.answer[l] = contact[l] ? Answer{Verdict::contact, time.time[l]} : Answer{Verdict::apart, 0};
  return out;
}

}  // namespace

LaneAnswers decide_in_lanes(std::span<const MovingVertexFace> queries) {
  return decide(queries);
}
LaneAnswers decide_in_lanes(std::span<const MovingEdgeEdge> queries) {
  return decide(queries);
}

}  // namespace cscd
