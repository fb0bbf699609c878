#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "core/elementary/published.h"
#include "core/elementary/question/elementary_test.h"
#include "core/elementary/question/filter.h"
#include "core/elementary/question/query_scale.h"
#include "core/elementary/question/relative_box.h"

// Interval Newton on the coplanarity cubic (section 7.1 of the paper; this root finder is the customary
// companion of the filter of Tang et al. 2010), in double or in single precision.
//
// The roots in [0, 1] are enclosed in ascending order; at each the features are tested for touching. The
// filter's "apart" is a proof for the coordinates as they are in that precision. What comes after it is not:
// an enclosure is found with rounded coefficients, and touching is judged at its middle within a tolerance.
// Hence contacts may be missed or invented near the limits of the precision; the harness counts both against
// the exact oracle. Degenerate cases follow rule degenerate: a cubic that may be zero throughout is reduced
// to two dimensions, and what is left open is `undecided`, never "apart".
namespace cscd {
namespace {

// The parts of a query in single precision.
struct FloatPoint {
  Eigen::Vector3f start, end;
  Eigen::Vector3f at(float t) const { return (1 - t) * start + t * end; }
};
struct FloatVertexFace {
  FloatPoint vertex, corner[3];
};
struct FloatEdgeEdge {
  FloatPoint first[2], second[2];
};
struct FloatVector {
  Eigen::Vector3f start, end;
  // The largest component, or NaN where coordinates were beyond the range of floats.
  float largest() const {
    Eigen::Matrix<float, 3, 2> ends;
    ends << start, end;
    return ends.cwiseAbs().maxCoeff<Eigen::PropagateNaN>();
  }
};
using FloatCubic = BernsteinCubicOf<float>;

inline FloatVector difference(const FloatPoint& from, const FloatPoint& to) {
  return {to.start - from.start, to.end - from.end};
}
// The triple product of bernstein.h, whose error bound holds for any unit roundoff.
inline FloatCubic float_triple_product(const FloatVector& a, const FloatVector& b, const FloatVector& c) {
  const Eigen::Vector3f n0 = a.start.cross(b.start), n1 = a.start.cross(b.end) + a.end.cross(b.start),
                        n2 = a.end.cross(b.end);
  const float area = a.largest() * b.largest(), volume = area * c.largest();
  const bool known = area >= 1e-28F && area <= 1e28F && volume >= 1e-28F && volume <= 1e28F;
  return {{n0.dot(c.start), (n1.dot(c.start) + n0.dot(c.end)) / 3, (n1.dot(c.end) + n2.dot(c.start)) / 3,
           n2.dot(c.end)},
          known ? 72 * 0x1p-24F * volume : std::numeric_limits<float>::infinity()};
}
inline FloatCubic coplanarity(const FloatVertexFace& q) {
  return float_triple_product(difference(q.corner[0], q.corner[1]), difference(q.corner[0], q.corner[2]),
                              difference(q.corner[0], q.vertex));
}
inline FloatCubic coplanarity(const FloatEdgeEdge& q) {
  return float_triple_product(difference(q.first[0], q.first[1]), difference(q.second[0], q.second[1]),
                              difference(q.first[0], q.second[0]));
}
inline MovingPoint widened(const FloatPoint& p) {
  return {p.start.cast<double>(), p.end.cast<double>()};
}
inline bool relative_boxes_apart(const FloatVertexFace& q) {
  return relative_boxes_apart(MovingVertexFace{
      widened(q.vertex), {widened(q.corner[0]), widened(q.corner[1]), widened(q.corner[2])}});
}
inline bool relative_boxes_apart(const FloatEdgeEdge& q) {
  return relative_boxes_apart(MovingEdgeEdge{{widened(q.first[0]), widened(q.first[1])},
                                             {widened(q.second[0]), widened(q.second[1])}});
}

struct NewtonLimits {
  // The width at which an enclosure of a root counts as found.
  double root_width;
  // The barycentric slack when touching is judged at a root: root width times motion, for features that move
  // up to 2^10 (in single precision 2^6) times their own size in the interval. The paper states no tolerance.
  double inside;
  // The sine of the angle below which a normal has no direction that the precision can trust.
  double parallel;
  // The errors of the cubic between which products of four lengths, as in squared areas, stay within range.
  double least_error, most_error;
};
// The types and limits of each precision.
struct DoubleNumbers {
  using Real = double;
  using Vec = Vec3;
  using Point = MovingPoint;
  using VertexFace = MovingVertexFace;
  using EdgeEdge = MovingEdgeEdge;
  using Vector = MovingVector;
  using Cubic = BernsteinCubic;
  static constexpr NewtonLimits limits{0x1p-40, 0x1p-30, 0x1p-26, 1e-230, 1e190};
};
struct FloatNumbers {
  using Real = float;
  using Vec = Eigen::Vector3f;
  using Point = FloatPoint;
  using VertexFace = FloatVertexFace;
  using EdgeEdge = FloatEdgeEdge;
  using Vector = FloatVector;
  using Cubic = FloatCubic;
  static constexpr NewtonLimits limits{0x1p-18, 0x1p-12, 0x1p-12, 0, 1e24};
};

// The search itself, for `Numbers` = DoubleNumbers or FloatNumbers.
template <class Numbers>
struct NewtonSearch {
  using Real = typename Numbers::Real;
  using Vec = typename Numbers::Vec;
  using Point = typename Numbers::Point;
  using VertexFace = typename Numbers::VertexFace;
  using EdgeEdge = typename Numbers::EdgeEdge;
  using Vector = typename Numbers::Vector;
  using Cubic = typename Numbers::Cubic;
  static constexpr Real kRootWidth = static_cast<Real>(Numbers::limits.root_width),
                        kInside = static_cast<Real>(Numbers::limits.inside),
                        kParallel = static_cast<Real>(Numbers::limits.parallel),
                        kLeastError = static_cast<Real>(Numbers::limits.least_error),
                        kMostError = static_cast<Real>(Numbers::limits.most_error);

  enum class Touch { no, yes, unclear };

  // Whether the point is within kInside of the segment a + [0, 1] ab, in lengths of the segment or of the
  // point's own distance from a.
  static bool near_segment(const Vec& p, const Vec& a, const Vec& ab) {
    const Vec ap = p - a;
    const Real length = ab.squaredNorm();
    const Real u = length > 0 ? std::clamp(ap.dot(ab) / length, Real(0), Real(1)) : 0;
    return (ap - u * ab).squaredNorm() <= kInside * kInside * std::max(length, ap.squaredNorm());
  }

  // Whether two vectors whose cross product has this squared length span a plane. They do not if they are
  // parallel, nor if one is so much shorter that rounding may have made its direction. False for NaN.
  static bool spans(Real squared_cross, const Vec& a, const Vec& b) {
    const Real longest = std::max(a.squaredNorm(), b.squaredNorm());
    return squared_cross > kParallel * kParallel * longest * longest;
  }

  // For two features known to be in one plane at time t: how far, in barycentric terms, the touching point is
  // inside each border. All margins are at least 0 where the features touch. Returns nothing where a feature
  // collapses or the two are parallel.
  static std::optional<std::array<Real, 3>> margins(const VertexFace& q, Real t) {
    const Vec a = q.corner[0].at(t), ab = q.corner[1].at(t) - a, ac = q.corner[2].at(t) - a,
              av = q.vertex.at(t) - a;
    const Vec n = ab.cross(ac);
    const Real area = n.squaredNorm();
    if (!spans(area, ab, ac)) return std::nullopt;
    const Real u = av.cross(ac).dot(n) / area, v = ab.cross(av).dot(n) / area;
    return std::array{u, v, 1 - u - v};
  }
  static std::optional<std::array<Real, 4>> margins(const EdgeEdge& q, Real t) {
    const Vec a = q.first[0].at(t), ab = q.first[1].at(t) - a, c = q.second[0].at(t),
              cd = q.second[1].at(t) - c;
    const Vec n = ab.cross(cd), ac = c - a;
    const Real area = n.squaredNorm();
    if (!spans(area, ab, cd)) return std::nullopt;
    const Real u = ac.cross(cd).dot(n) / area, v = ac.cross(ab).dot(n) / area;
    return std::array{u, 1 - u, v, 1 - v};
  }

  // Whether the features touch where there are no margins: the triangle is then hardly more than its edges.
  static bool near_collapsed(const VertexFace& q, Real t) {
    const Vec v = q.vertex.at(t), a = q.corner[0].at(t), b = q.corner[1].at(t), c = q.corner[2].at(t);
    return near_segment(v, a, b - a) || near_segment(v, b, c - b) || near_segment(v, c, a - c);
  }
  // Parallel segments have their smallest distance at an end.
  static bool near_collapsed(const EdgeEdge& q, Real t) {
    const Vec a = q.first[0].at(t), b = q.first[1].at(t), c = q.second[0].at(t), d = q.second[1].at(t);
    return near_segment(a, c, d - c) || near_segment(b, c, d - c) || near_segment(c, a, b - a) ||
           near_segment(d, a, b - a);
  }

  // Whether the features touch at time t, when they are known to be in one plane.
  template <class Query>
  static Touch touch(const Query& q, Real t) {
    const auto inside = margins(q, t);
    if (!inside) return near_collapsed(q, t) ? Touch::unclear : Touch::no;
    return *std::min_element(inside->begin(), inside->end()) >= -kInside ? Touch::yes : Touch::no;
  }

  // `during` gives the part of a motion between the times `low` and `high`, as a motion over [0, 1].
  static Point during(const Point& p, Real low, Real high) { return {p.at(low), p.at(high)}; }
  static VertexFace during(const VertexFace& q, Real low, Real high) {
    const auto part = [=](const Point& p) { return during(p, low, high); };
    return {part(q.vertex), {part(q.corner[0]), part(q.corner[1]), part(q.corner[2])}};
  }
  static EdgeEdge during(const EdgeEdge& q, Real low, Real high) {
    const auto part = [=](const Point& p) { return during(p, low, high); };
    return {{part(q.first[0]), part(q.first[1])}, {part(q.second[0]), part(q.second[1])}};
  }

  // The result of a search so far. It is "apart" until the features may touch at some time.
  struct FirstTouch {
    Answer answer{Verdict::apart, 0};

    // Takes the finding at the next root, whose time is `earliest` or later. Returns true if the search is
    // over.
    bool offer(Touch found, Real earliest) {
      if (found == Touch::no) return false;
      answer = {found == Touch::yes ? Verdict::contact : Verdict::undecided, earliest};
      return true;
    }
  };

  // Candidate times: both ends, at most two roots for each of four lines, and one for each of three axes of
  // four pairs.
  struct Times {
    std::array<Real, 22> at{};
    std::size_t count = 0;
    void add(Real t) {
      if (t >= 0 && t <= 1) at[count++] = t;
    }
  };

  // Adds the times at which p is on the line ab: the roots of twice the signed area of (a, b, p), a quadratic
  // in Bernstein form, projected along the axis that shows most of it.
  static void add_crossings(const Point& a, const Point& b, const Point& p, Times& times) {
    const Vector ab = difference(a, b), ap = difference(a, p);
    const Vec area[3] = {ab.start.cross(ap.start), (ab.start.cross(ap.end) + ab.end.cross(ap.start)) / 2,
                         ab.end.cross(ap.end)};
    int axis = 0;
    (area[0].cwiseAbs() + area[1].cwiseAbs() + area[2].cwiseAbs()).maxCoeff(&axis);
    const Real c0 = area[0][axis], c1 = area[1][axis], c2 = area[2][axis];
    const Real square = c0 - 2 * c1 + c2, half_b = c1 - c0;
    const Real discriminant = std::max(Real(0), half_b * half_b - square * c0);
    const Real q = -(half_b + std::copysign(std::sqrt(discriminant), half_b));
    times.add(q / square);
    times.add(c0 / q);
  }

  // Adds the times at which p and q have a coordinate in common, for features that move along one line, where
  // nothing crosses a line.
  static void add_meetings(const Point& p, const Point& q, Times& times) {
    for (int axis = 0; axis < 3; ++axis) {
      const Real start = q.start[axis] - p.start[axis], end = q.end[axis] - p.end[axis];
      times.add(start / (start - end));
    }
  }

  // Adds the times at which features that are coplanar throughout can begin to touch: when a point crosses
  // the line of an edge, or, on one line, meets another point. (Beside these there is t = 0.)
  static void add_events(const VertexFace& q, Times& times) {
    for (int k = 0; k < 3; ++k) {
      add_crossings(q.corner[k], q.corner[(k + 1) % 3], q.vertex, times);
      add_meetings(q.corner[k], q.vertex, times);
    }
  }
  static void add_events(const EdgeEdge& q, Times& times) {
    for (int k = 0; k < 2; ++k) {
      add_crossings(q.first[0], q.first[1], q.second[k], times);
      add_crossings(q.second[0], q.second[1], q.first[k], times);
      for (int l = 0; l < 2; ++l) add_meetings(q.first[k], q.second[l], times);
    }
  }

  // The answer for features that are coplanar throughout, within rounding.
  template <class Query>
  static Answer planar(const Query& query) {
    if (relative_boxes_apart(query)) return {Verdict::apart, 0};
    Times times;
    times.add(0);
    times.add(1);  // because a root at 1 may be rounded past 1
    add_events(query, times);
    std::sort(times.at.begin(), times.at.begin() + times.count);
    FirstTouch search;
    for (std::size_t i = 0; i < times.count; ++i)
      if (search.offer(touch(query, times.at[i]), times.at[i])) break;
    return search.answer;
  }

  // Whether the features touch between two times, when all that is known is that they may be in one plane
  // there, mostly near a double root. The answer is "no" only where one border keeps them apart by more than
  // its margin changes, or where parallel features stay apart as if they were in one plane throughout.
  template <class Query>
  static Touch touch_between(const Query& q, Real low, Real high) {
    if (relative_boxes_apart(during(q, low, high))) return Touch::no;
    const auto first = margins(q, low), middle = margins(q, (low + high) / 2), last = margins(q, high);
    if (!first || !middle || !last)
      return planar(during(q, low, high)).verdict == Verdict::apart ? Touch::no : Touch::unclear;
    bool inside = true;
    for (std::size_t k = 0; k < middle->size(); ++k) {
      const auto [least, most] = std::minmax({(*first)[k], (*middle)[k], (*last)[k]});
      if (most + (most - least) < -kInside) return Touch::no;
      inside = inside && least >= -kInside;
    }
    return inside ? Touch::yes : Touch::unclear;
  }

  // The polar form of the cubic: its control points on [a, b] are blossom(a,a,a), (a,a,b), (a,b,b), (b,b,b).
  static Real blossom(const Real (&c)[4], Real r, Real s, Real t) {
    const auto mix = [](Real x, Real y, Real w) { return (1 - w) * x + w * y; };
    const Real d0 = mix(c[0], c[1], r), d1 = mix(c[1], c[2], r), d2 = mix(c[2], c[3], r);
    return mix(mix(d0, d1, s), mix(d1, d2, s), t);
  }

  // Visits enclosures of the roots in [low, high] in ascending order until one ends the search.
  template <class Query>
  static bool search_roots(const Query& query, const Cubic& f, Real low, Real high, FirstTouch& search) {
    while (true) {
      const Real control[4] = {blossom(f.c, low, low, low), blossom(f.c, low, low, high),
                               blossom(f.c, low, high, high), blossom(f.c, high, high, high)};
      const auto [least, most] = std::minmax({control[0], control[1], control[2], control[3]});
      if (least > f.error || most < -f.error) return false;
      // If the enclosure is narrow enough, or the cubic is flat within rounding, no further cut tells more
      // about the place of the root.
      if (high - low <= kRootWidth) return search.offer(touch(query, (low + high) / 2), low);
      if (least >= -f.error && most <= f.error) return search.offer(touch_between(query, low, high), low);

      // The derivative's range on [low, high], from its own control points.
      const Real scale = 3 / (high - low);
      const auto [slope_least, slope_most] =
          std::minmax({scale * (control[1] - control[0]), scale * (control[2] - control[1]),
                       scale * (control[3] - control[2])});
      const Real middle = (low + high) / 2;
      Real new_low = low, new_high = high;
      if (slope_least > 0 || slope_most < 0) {
        const Real value = blossom(f.c, middle, middle, middle);
        const Real pad = f.error / std::min(std::abs(slope_least), std::abs(slope_most));
        const Real r = middle - value / slope_least, s = middle - value / slope_most;
        new_low = std::max(low, std::min(r, s) - pad);
        new_high = std::min(high, std::max(r, s) + pad);
        if (new_low > new_high) return false;
        if (new_high - new_low < (high - low) / 2) {
          low = new_low, high = new_high;
          continue;
        }
      }
      if (search_roots(query, f, low, middle, search)) return true;
      low = middle;
    }
  }

  // Answers a query in this precision. Says nothing where products may leave the range.
  template <class Query>
  static std::optional<Answer> answer(const Query& query) {
    const Cubic f = coplanarity(query);
    if (certain_sign(f) != 0) return Answer{Verdict::apart, 0};
    if (!(f.error >= kLeastError && f.error <= kMostError)) return std::nullopt;
    const auto [least, most] = std::minmax({f.c[0], f.c[1], f.c[2], f.c[3]});
    if (least >= -f.error && most <= f.error) return planar(query);
    FirstTouch search;
    search_roots(query, f, 0, 1, search);
    return search.answer;
  }
};

// If the error bound says nothing about the query, the query is scaled to the size of 1 and tried again. If
// its scales are too far apart for that too, only the relative boxes decide.
template <class Query>
Answer newton(const Query& query) {
  using Search = NewtonSearch<DoubleNumbers>;
  if (const auto answer = Search::answer(query)) return *answer;
  if (const auto answer = Search::answer(scaled_to_unit(query))) return *answer;
  return {relative_boxes_apart(query) ? Verdict::apart : Verdict::undecided, 0};
}

FloatPoint rounded(const MovingPoint& p) {
  return {p.start.cast<float>(), p.end.cast<float>()};
}
FloatVertexFace rounded(const MovingVertexFace& q) {
  return {rounded(q.vertex), {rounded(q.corner[0]), rounded(q.corner[1]), rounded(q.corner[2])}};
}
FloatEdgeEdge rounded(const MovingEdgeEdge& q) {
  return {{rounded(q.first[0]), rounded(q.first[1])}, {rounded(q.second[0]), rounded(q.second[1])}};
}

template <class Query>
Answer newton_in_floats(const Query& query) {
  using Search = NewtonSearch<FloatNumbers>;
  if (const auto answer = Search::answer(rounded(query))) return *answer;
  const auto scaled = rounded(scaled_to_unit(query));
  if (const auto answer = Search::answer(scaled)) return *answer;
  return {relative_boxes_apart(query) ? Verdict::apart : Verdict::undecided, 0};
}

}  // namespace

Answer newton_vertex_face(const MovingVertexFace& query) {
  return newton(query);
}
Answer newton_edge_edge(const MovingEdgeEdge& query) {
  return newton(query);
}
Answer newton_float_vertex_face(const MovingVertexFace& query) {
  return newton_in_floats(query);
}
Answer newton_float_edge_edge(const MovingEdgeEdge& query) {
  return newton_in_floats(query);
}

}  // namespace cscd
