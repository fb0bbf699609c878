#include "core/elementary/certified/exact_lanes.h"

#include <algorithm>

#include "core/elementary/certified/doubles_stage.h"
#include "core/geometry/triple_product_lanes.h"

namespace cscd {
namespace {

constexpr int kSteps = 12;  // the most steps of Newton's iteration; nearly all queries need four or five

// Loads the queries into lanes. Lanes without a query hold the last query again.
template <class Query>
TriplePoints<VectorLanes> load(std::span<const Query* const> queries) {
  TriplePoints<VectorLanes> out;
  for (std::size_t l = 0; l < kLanes; ++l) {
    const auto points = triple_points(*queries[std::min(l, queries.size() - 1)]);
    const auto set = [l](VectorLanes& lanes, const MovingPoint& p) {
      for (int i = 0; i < 3; ++i) lanes.at[0][i][l] = p.start[i], lanes.at[1][i][l] = p.end[i];
    };
    set(out.from, points.from), set(out.p_to, points.p_to), set(out.q_from, points.q_from);
    set(out.q_to, points.q_to), set(out.r_to, points.r_to);
  }
  return out;
}

// The vectors of eight queries and their coplanarity cubics.
struct Lanes {
  VectorLanes p, q, r;
  CubicOf<Lane8> cubic;
  Sign8 never_coplanar;

  explicit Lanes(const TriplePoints<VectorLanes>& points)
      : Lanes(points.p_to - points.from, points.q_to - points.q_from, points.r_to - points.from) {}
  Sizes<Lane8> sizes() const { return {p.largest_component(), q.largest_component(), r.largest_component()}; }

 private:
  Lanes(const VectorLanes& p, const VectorLanes& q, const VectorLanes& r)
      : Lanes(p, q, r, triple_products(cross(p, q), r)) {}
  Lanes(const VectorLanes& p, const VectorLanes& q, const VectorLanes& r, const BernsteinLanes& f)
      : p(p), q(q), r(r), cubic(f, ProvenBounds::cubic), never_coplanar(certain_sign(f)) {}
};

VectorLanes between(const VectorLanes& x, Lane8 low, Lane8 high) {
  VectorLanes out;
  for (int i = 0; i < 3; ++i) {
    out.at[0][i] = (1 - low) * x.at[0][i] + low * x.at[1][i];
    out.at[1][i] = (1 - high) * x.at[0][i] + high * x.at[1][i];
  }
  return out;
}

// The signs of control points, as far as they are certain: 1, -1 or 0.
Sign8 signs(Lane8 control, Lane8 error) {
  return (control < -error) - (control > error);
}
// Counts roots by Descartes' rule, as count_roots() of doubles_stage.h does. In all other lanes the number is
// unclear.
struct RootLanes {
  Sign8 none, one;

  RootLanes(const Lane8 (&control)[4], Lane8 error) {
    const Sign8 s0 = signs(control[0], error), s1 = signs(control[1], error), s2 = signs(control[2], error),
                s3 = signs(control[3], error);
    none = (s0 != 0) & (s1 == s0) & (s2 == s0) & (s3 == s0);
    one = (s0 != 0) & (s3 == -s0) & ((s1 == s0) | (s2 == -s0));
  }
};

struct Enclosure {
  Lane8 low, high;
  Sign8 certain;  // the root is certainly between `low` and `high`
};
// Encloses the only root of each cubic between `low` and `high` in the lanes `which`.
Enclosure enclosed(CubicOf<Lane8> cubic, Sign8 which, Lane8 low, Lane8 high) {
  const Sign8 rises = cubic.at(low) < 0;
  for (Lane8& c : cubic.f.c) c = select(rises, -c, c);
  const Lane8 first = low, last = high, at_low = cubic.at(low), at_high = cubic.at(high);
  Lane8 t = low + (high - low) * (at_low / (at_low - at_high)), value, slope;
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
  low = larger(t - reach, first), high = smaller(t + reach, last);
  return {low, high, which & (cubic.at(low) > cubic.error) & (cubic.at(high) < -cubic.error)};
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

// Where the features are when they are in one plane, in lanes whose root is enclosed.
template <class Query>
Place<Lane8> place_in(const Lanes& v, const Enclosure& root) {
  const VectorLanes p = between(v.p, root.low, root.high), q = between(v.q, root.low, root.high),
                    r = between(v.r, root.low, root.high);
  const Axis axis(p, q);
  const Place<Lane8> place =
      place_along<Query, ProvenBounds>(axis.seen(p), axis.seen(q), axis.seen(r), v.sizes());
  return {place.outside & root.certain, place.inside & root.certain};
}

// The times at which each cubic has an extreme, in ascending order. Lanes without one, or with one beyond
// [0, 1], have 0 or 1 there. Whatever follows is right for any choice of times.
struct Extremes {
  Lane8 first, second;

  explicit Extremes(const Lane8 (&c)[4]) {
    // f' / 3 = a t^2 + 2 b t + d0.
    const Lane8 d0 = c[1] - c[0], d1 = c[2] - c[1], a = d0 - 2 * d1 + (c[3] - c[2]), b = d1 - d0;
    const Lane8 root = square_root(larger(b * b - a * d0, Lane8{})), q = -(b + select(b < 0, -root, root));
    const auto in_interval = [](Lane8 t) { return select(t > 0, smaller(t, Lane8{} + 1), Lane8{}); };
    const Lane8 x = in_interval(q / a), y = in_interval(d0 / q);
    first = smaller(x, y), second = larger(x, y);
  }
};

// The control points of each cubic between `low` and `high`.
void control_points(const Lane8 (&c)[4], Lane8 low, Lane8 high, Lane8 (&out)[4]) {
  const auto polar = [&](Lane8 r, Lane8 s, Lane8 t) {
    const auto mixed = [](Lane8 x, Lane8 y, Lane8 at) { return (1 - at) * x + at * y; };
    const Lane8 x = mixed(c[0], c[1], r), y = mixed(c[1], c[2], r), z = mixed(c[2], c[3], r);
    return mixed(mixed(x, y, s), mixed(y, z, s), t);
  };
  out[0] = polar(low, low, low), out[1] = polar(low, low, high);
  out[2] = polar(low, high, high), out[3] = polar(high, high, high);
}

}  // namespace

template <class Query>
LaneFindings find_once_in_lanes(std::span<const Query* const> queries) {
  const Lanes v(load(queries));
  const RootLanes roots(v.cubic.f.c, v.cubic.error);
  const Enclosure root = enclosed(v.cubic, roots.one, Lane8{}, Lane8{} + 1);
  const Place<Lane8> place = place_in<Query>(v, root);
  return {bits_of(v.never_coplanar | place.outside), bits_of(place.inside), root.low, root.high};
}

template <class Query>
LaneFindings find_in_parts_in_lanes(std::span<const Query* const> queries) {
  const Lanes v(load(queries));
  const Extremes extreme(v.cubic.f.c);
  const Lane8 cut[] = {Lane8{}, extreme.first, extreme.second, Lane8{} + 1};
  Sign8 open = Sign8(Lane8{} == Lane8{}), contact = {};
  LaneFindings out;
  for (int part = 0; part < 3 && bits_of(open) != 0; ++part) {
    const Lane8 low = cut[part], high = cut[part + 1];
    const Sign8 empty = low >= high;
    Lane8 control[4];
    control_points(v.cubic.f.c, low, high, control);
    const RootLanes roots(control, v.cubic.error);
    const Sign8 one = roots.one & open & ~empty;
    Sign8 outside = {};
    if (bits_of(one) != 0) {
      const Enclosure root = enclosed(v.cubic, one, low, high);
      const Place<Lane8> place = place_in<Query>(v, root);
      outside = place.outside;
      const Sign8 met = place.inside & one;
      contact |= met;
      out.low = select(met, root.low, out.low), out.high = select(met, root.high, out.high);
    }
    open &= empty | roots.none | (one & outside);
  }
  out.apart = bits_of(open), out.contact = bits_of(contact);
  return out;
}

template <class Query>
CertainTime<Lane8> times_in_lanes(std::span<const Query* const> queries, Lane8 low, Lane8 high) {
  const TriplePoints<VectorLanes> points = load(queries);
  const Lanes v(points);
  return time_in_pairs(points, v.sizes(), v.cubic, low, high);
}

template LaneFindings find_once_in_lanes(std::span<const MovingVertexFace* const>);
template LaneFindings find_once_in_lanes(std::span<const MovingEdgeEdge* const>);
template LaneFindings find_in_parts_in_lanes(std::span<const MovingVertexFace* const>);
template LaneFindings find_in_parts_in_lanes(std::span<const MovingEdgeEdge* const>);
template CertainTime<Lane8> times_in_lanes(std::span<const MovingVertexFace* const>, Lane8, Lane8);
template CertainTime<Lane8> times_in_lanes(std::span<const MovingEdgeEdge* const>, Lane8, Lane8);

}  // namespace cscd
