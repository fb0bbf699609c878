#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/rounding.h"
#include "core/elementary/published.h"
#include "core/elementary/question/filter.h"
#include "core/elementary/question/query_scale.h"

// Inclusion-based root finding (Snyder, "Interval analysis for computer graphics", SIGGRAPH 1992; Redon,
// Kheddar and Coquillart 2002; Wang, Ferguson, Schneider, Jiang, Attene and Panozzo, "A large-scale benchmark
// and an inclusion-based algorithm for continuous collision detection", ACM TOG 40(5), 2021).
//
// F(t, u, v) is the vector between the points with parameters u, v of the two features at time t. It is
// affine in each of its three arguments, so over a box of arguments it stays in the hull of its values at
// the eight corners of the box. A box is dropped if its hull, padded by the rounding error, leaves out the
// origin. Any other box is cut in half along the argument that moves F most, until the hull is smaller than
// the tolerance along every axis.
//
// There are four differences to Wang et al.:
// - The search goes depth first, takes the earlier half first, and drops every box that begins after a
//   contact already found. It needs no queue and no allocation.
// - The query is seen from one of its moving points. So the rounding error grows with the size of the query
//   and its relative motion, and not with its distance from the origin. (The bound of Wang et al. grows
//   with min(1, x) where max(1, x) is needed, and misses contacts far from the origin.)
// - The tolerance is relative to the query, and never smaller than rounding can tell apart.
// - A certified non-penetration filter stands in front.
//
// At a distance r, the papers' minimum separation, a box is dropped if its hull stays out of the cube of the
// points within r of the origin along every axis, and no filter stands in front. The cube holds the ball of
// radius r, so "apart" stays a proof; a "contact" may be features that are sqrt(3) r apart.
//
// An "apart" is a proof. A "contact" bounds the distance, not the error in time: slow features are reported
// early. A box takes about 50 ns. Most pairs that are apart take one box, and near misses take thousands.
namespace cscd {
namespace {

// Bounds of the rounding error of F along an axis: kRelativeError times M plus kUnderflow, where M is the
// largest relative coordinate along the axis.
//
// Arguments are dyadic numbers with at most 52 binary places, so they, their differences from 1, and u + v
// are exact. Let u be the unit roundoff. A coordinate is off by u M, and a point at time t by 2 u M more.
// The weights of a vertex-face query sum to at most 3, which gives (3 + 6 + 9) u M for the point of the
// face and 3 u M for the vertex. The last subtraction rounds a number of up to 4 M. That is 25 u M in all,
// and less for two edges. The constant 28 also pays for terms of second order. kUnderflow pays for products
// that underflow and for coordinates moved by in_range.
constexpr double kRelativeError = 28 * kUnitRoundoff, kUnderflow = 0x1p-1060;
// The smallest hull that the search may have to reach, in rounding errors. It is reached before 52 halvings.
constexpr double kResolution = 64;

struct Range {
  double low, high;
  double middle() const { return (low + high) / 2; }
};
struct Box {
  Range t, u, v;
};

// F at the corners of a box: [axis][corner], where corner 4 t + 2 u + v has the high ends of t, u and v where
// these are 1.
using Corners = std::array<std::array<double, 8>, 3>;

double at(const MovingPoint& p, double t, int axis) {
  return (1 - t) * p.start[axis] + t * p.end[axis];
}

Corners corners(const MovingVertexFace& q, const Box& box) {
  Corners f;
  for (int axis = 0; axis < 3; ++axis) {
    std::size_t k = 0;
    for (const double t : {box.t.low, box.t.high}) {
      const double p = at(q.vertex, t, axis), a = at(q.corner[0], t, axis), b = at(q.corner[1], t, axis),
                   c = at(q.corner[2], t, axis);
      for (const double u : {box.u.low, box.u.high})
        for (const double v : {box.v.low, box.v.high})
          f[static_cast<std::size_t>(axis)][k++] = p - ((1 - u - v) * a + u * b + v * c);
    }
  }
  return f;
}
Corners corners(const MovingEdgeEdge& q, const Box& box) {
  Corners f;
  for (int axis = 0; axis < 3; ++axis) {
    std::size_t k = 0;
    for (const double t : {box.t.low, box.t.high}) {
      const double a = at(q.first[0], t, axis), b = at(q.first[1], t, axis), c = at(q.second[0], t, axis),
                   d = at(q.second[1], t, axis);
      for (const double u : {box.u.low, box.u.high})
        for (const double v : {box.v.low, box.v.high})
          f[static_cast<std::size_t>(axis)][k++] = ((1 - u) * a + u * b) - ((1 - v) * c + v * d);
    }
  }
  return f;
}

// True if some arguments in the box are parameters of points of the features. The first corner of the box
// is then one of these.
bool in_domain(const MovingVertexFace&, const Box& box) {
  return box.u.low + box.v.low <= 1;
}
bool in_domain(const MovingEdgeEdge&, const Box&) {
  return true;
}

struct Hull {
  bool has_origin = true, is_near = true;  // some of it may be near the origin; all of it is
  double width = 0;                        // the longest side
};
Hull hull(const Corners& f, const Vec3& near) {
  Hull result;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double low = f[axis][0], high = low;
    for (std::size_t k = 1; k < 8; ++k) {
      low = std::min(low, f[axis][k]);
      high = std::max(high, f[axis][k]);
    }
    const double pad = near[static_cast<Eigen::Index>(axis)];
    result.has_origin &= low <= pad && high >= -pad;
    result.is_near &= low >= -pad && high <= pad;
    result.width = std::max(result.width, high - low);
  }
  return result;
}

// The largest motion of a component of F over the box, for each argument.
std::array<double, 3> motions(const Corners& f) {
  std::array<double, 3> most{};
  constexpr std::array<std::size_t, 3> step = {4, 2, 1};
  for (std::size_t argument = 0; argument < 3; ++argument)
    for (const auto& axis : f)
      for (std::size_t k = 0; k < 8; ++k)
        if ((k & step[argument]) == 0)
          most[argument] = std::max(most[argument], std::abs(axis[k + step[argument]] - axis[k]));
  return most;
}

// The stack of the depth-first search. It holds one waiting box for each halving that led to the current box.
class Waiting {
 public:
  bool empty() const { return size_ == 0; }
  void push(const Box& box) { boxes_[size_++] = box; }
  Box pop() { return boxes_[--size_]; }
  double earliest() const {
    double time = 1;
    for (std::size_t i = 0; i < size_; ++i) time = std::min(time, boxes_[i].t.low);
    return time;
  }

 private:
  std::array<Box, 3 * 52 + 2> boxes_;
  std::size_t size_ = 0;
};

template <class Query>
Answer inclusion(const Query& given, double r, const TestParameters& parameters) {
  if (r == 0 && never_coplanar(given)) return {Verdict::apart, 0};
  const Query query = relative(in_range(given));
  r = std::ldexp(r, range_exponent(given));
  const Vec3 error = kRelativeError * largest_coordinates(query) + Vec3::Constant(kUnderflow);
  const double small = std::max(parameters.tolerance * extent(query), kResolution * error.maxCoeff());
  // What may be the origin, or within r of it; the factor pays for the rounding of the sum.
  const Vec3 near = r == 0 ? error : Vec3((1 + 4 * kUnitRoundoff) * (error + Vec3::Constant(r)));

  Waiting waiting;
  waiting.push({{0, 1}, {0, 1}, {0, 1}});
  Answer answer{Verdict::apart, 2};  // a contact must be earlier than this
  for (std::int64_t step = 0; !waiting.empty(); ++step) {
    if (step == parameters.steps) {
      answer.time = std::min(answer.time, waiting.earliest());
      if (answer.verdict == Verdict::apart) answer.verdict = Verdict::undecided;
      return answer;
    }
    const Box box = waiting.pop();
    if (box.t.low >= answer.time || !in_domain(query, box)) continue;
    const Corners f = corners(query, box);
    const Hull over = hull(f, near);
    if (!over.has_origin) continue;
    if (over.width <= small || (r > 0 && over.is_near)) {
      answer = {Verdict::contact, box.t.low};
      continue;
    }
    const std::array<double, 3> motion = motions(f);
    Box first = box, second = box;
    if (motion[0] >= motion[1] && motion[0] >= motion[2])
      first.t.high = second.t.low = box.t.middle();
    else if (motion[1] >= motion[2])
      first.u.high = second.u.low = box.u.middle();
    else
      first.v.high = second.v.low = box.v.middle();
    waiting.push(second);
    waiting.push(first);
  }
  return answer;
}

}  // namespace

Answer inclusion_vertex_face(const MovingVertexFace& query, const TestParameters& parameters) {
  return inclusion(query, 0, parameters);
}
Answer inclusion_edge_edge(const MovingEdgeEdge& query, const TestParameters& parameters) {
  return inclusion(query, 0, parameters);
}
Answer inclusion_vertex_face_close(const MovingVertexFace& query, double r,
                                   const TestParameters& parameters) {
  return inclusion(query, r, parameters);
}
Answer inclusion_edge_edge_close(const MovingEdgeEdge& query, double r, const TestParameters& parameters) {
  return inclusion(query, r, parameters);
}

}  // namespace cscd
