#include "core/elementary/inclusion.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/rounding.h"
#include "core/elementary/question/filter.h"
#include "core/elementary/question/query_scale.h"

// Inclusion-based root finding (Snyder, "Interval analysis for computer graphics", SIGGRAPH 1992; Redon,
// Kheddar and Coquillart 2002; Wang, Ferguson, Schneider, Jiang, Attene and Panozzo, "A large-scale benchmark
// and an inclusion-based algorithm for continuous collision detection", ACM TOG 40(5), 2021).
//
// F(t, u, v), the vector between the points with parameters u, v of the two features at time t, is affine in
// each of its three arguments, so over a box of them it stays in the hull of its values at the eight corners.
// Boxes whose hull, padded by the rounding error, leaves out the origin are dropped; the others are cut in
// half along the argument that moves F most, until the hull is smaller than the tolerance along every axis.
//
// Differences to Wang et al.: depth first with the earlier half in front and everything dropped that begins
// after a contact already found (no queue, no allocation); everything is seen from one of the points in
// motion, so that the rounding error grows with the size of the query and its relative motion, not with its
// distance from the origin (theirs grows with min(1, x) where max(1, x) is needed, and misses contacts
// there); the tolerance is relative to the query and never below what rounding can tell apart; a certified
// non-penetration filter stands in front.
//
// A "no" is a proof. A "contact" bounds the distance, not the error in time: features that are slow are
// early. Cost: about 50 ns a box; one box for most pairs that are apart, thousands for near misses.
namespace cscd {
namespace {

// Arguments are dyadic numbers with at most 52 binary places, so they, their differences from 1 and u + v are
// exact. With u the unit roundoff and M the largest relative coordinate along the axis: coordinates are off
// by u M; a point at time t by 2 u M more; weights of a vertex-face query sum to at most 3, which gives (3 +
// 6 + 9) u M for the point of the face and 3 u M for the vertex; the last subtraction rounds 4 M. 25 u M in
// all, less for two edges. 28 also pays for terms of second order; the constant for products that underflow
// and for coordinates moved by in_range.
constexpr double kRelativeError = 28 * kUnitRoundoff, kUnderflow = 0x1p-1060;
// No hull is asked to be smaller than this many rounding errors; it is reached before 52 halvings.
constexpr double kResolution = 64;

struct Range {
  double low, high;
  double middle() const { return (low + high) / 2; }
};
struct Box {
  Range t, u, v;
};

// F at the corners of a box, axis by axis: corner number 4 t + 2 u + v.
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

// Has the box any point of the features' own? Its first corner is one then.
bool in_domain(const MovingVertexFace&, const Box& box) {
  return box.u.low + box.v.low <= 1;
}
bool in_domain(const MovingEdgeEdge&, const Box&) {
  return true;
}

struct Hull {
  bool has_origin = true;
  double width = 0;  // the longest side
};
Hull hull(const Corners& f, const Vec3& error) {
  Hull result;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double low = f[axis][0], high = low;
    for (std::size_t k = 1; k < 8; ++k) {
      low = std::min(low, f[axis][k]);
      high = std::max(high, f[axis][k]);
    }
    const double pad = error[static_cast<Eigen::Index>(axis)];
    result.has_origin &= low <= pad && high >= -pad;
    result.width = std::max(result.width, high - low);
  }
  return result;
}

// How far F moves along each argument, at most.
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

// Depth first: a box waiting for each halving above the one in hand.
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
Answer inclusion(const Query& given, const TestParameters& parameters) {
  if (never_coplanar(given)) return {Verdict::apart, 0};
  const Query query = relative(in_range(given));
  const Vec3 error = kRelativeError * largest_coordinates(query) + Vec3::Constant(kUnderflow);
  const double small = std::max(parameters.tolerance * extent(query), kResolution * error.maxCoeff());

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
    const Hull over = hull(f, error);
    if (!over.has_origin) continue;
    if (over.width <= small) {
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
  return inclusion(query, parameters);
}
Answer inclusion_edge_edge(const MovingEdgeEdge& query, const TestParameters& parameters) {
  return inclusion(query, parameters);
}

}  // namespace cscd
