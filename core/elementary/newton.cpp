#include "core/elementary/newton.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "core/elementary/filter.h"
#include "core/elementary/relative_box.h"

// Interval Newton on the coplanarity cubic (section 7.1 of the paper; the root finder is the one customary
// with the filter of Tang et al. 2010), in double precision.
//
// The roots in [0, 1] are enclosed in ascending order; at each the features are tested for touching. The
// filter's "apart" is a proof. What comes after it is not: an enclosure is found with rounded coefficients,
// and touching is judged at its middle within a tolerance. Hence contacts may be missed or invented near the
// limits of double precision; the harness counts both against the exact referee. Degenerate cases follow trap
// 8: a cubic that may be zero throughout is reduced to two dimensions, and what is left open is `undecided`,
// never "apart".
namespace cscd {
namespace {

// Width at which an enclosure of a root counts as found.
constexpr double kRootWidth = 0x1p-40;
// Barycentric slack when touching is judged at a root: root width times motion, for features that move up to
// 2^10 times their own size in the interval. The paper states no tolerance.
constexpr double kInside = 0x1p-30;
// Sine of the angle below which a normal has no direction that double precision can trust.
constexpr double kParallel = 0x1p-26;

enum class Touch { no, yes, unclear };

// Is the point within kInside of the segment a + [0, 1] ab, in lengths of the segment or of its own distance
// from a?
bool near_segment(const Vec3& p, const Vec3& a, const Vec3& ab) {
  const Vec3 ap = p - a;
  const double length = ab.squaredNorm();
  const double u = length > 0 ? std::clamp(ap.dot(ab) / length, 0.0, 1.0) : 0;
  return (ap - u * ab).squaredNorm() <= kInside * kInside * std::max(length, ap.squaredNorm());
}

// Do two vectors whose cross product has this squared length span a plane? Not if they are parallel, nor if
// one is so much shorter that rounding may have made its direction. False for NaN.
bool spans(double squared_cross, const Vec3& a, const Vec3& b) {
  const double longest = std::max(a.squaredNorm(), b.squaredNorm());
  return squared_cross > kParallel * kParallel * longest * longest;
}

// Of two features known to be in one plane at time t: how far, in barycentric terms, the touching point is
// inside each border, all at least 0 where they touch. Nothing where a feature collapses or the two are
// parallel.
std::optional<std::array<double, 3>> margins(const MovingVertexFace& q, double t) {
  const Vec3 a = q.corner[0].at(t), ab = q.corner[1].at(t) - a, ac = q.corner[2].at(t) - a,
             av = q.vertex.at(t) - a;
  const Vec3 n = ab.cross(ac);
  const double area = n.squaredNorm();
  if (!spans(area, ab, ac)) return std::nullopt;
  const double u = av.cross(ac).dot(n) / area, v = ab.cross(av).dot(n) / area;
  return std::array{u, v, 1 - u - v};
}
std::optional<std::array<double, 4>> margins(const MovingEdgeEdge& q, double t) {
  const Vec3 a = q.first[0].at(t), ab = q.first[1].at(t) - a, c = q.second[0].at(t),
             cd = q.second[1].at(t) - c;
  const Vec3 n = ab.cross(cd), ac = c - a;
  const double area = n.squaredNorm();
  if (!spans(area, ab, cd)) return std::nullopt;
  const double u = ac.cross(cd).dot(n) / area, v = ac.cross(ab).dot(n) / area;
  return std::array{u, 1 - u, v, 1 - v};
}

// Where there are no margins. The triangle is hardly more than its edges.
bool near_collapsed(const MovingVertexFace& q, double t) {
  const Vec3 v = q.vertex.at(t), a = q.corner[0].at(t), b = q.corner[1].at(t), c = q.corner[2].at(t);
  return near_segment(v, a, b - a) || near_segment(v, b, c - b) || near_segment(v, c, a - c);
}
// Parallel segments are nearest to each other at an end.
bool near_collapsed(const MovingEdgeEdge& q, double t) {
  const Vec3 a = q.first[0].at(t), b = q.first[1].at(t), c = q.second[0].at(t), d = q.second[1].at(t);
  return near_segment(a, c, d - c) || near_segment(b, c, d - c) || near_segment(c, a, b - a) ||
         near_segment(d, a, b - a);
}

// Do the features touch at time t, when they are known to be in one plane?
template <class Query>
Touch touch(const Query& q, double t) {
  const auto inside = margins(q, t);
  if (!inside) return near_collapsed(q, t) ? Touch::unclear : Touch::no;
  return *std::min_element(inside->begin(), inside->end()) >= -kInside ? Touch::yes : Touch::no;
}

MovingPoint during(const MovingPoint& p, double low, double high) {
  return {p.at(low), p.at(high)};
}
MovingVertexFace during(const MovingVertexFace& q, double low, double high) {
  const auto part = [=](const MovingPoint& p) { return during(p, low, high); };
  return {part(q.vertex), {part(q.corner[0]), part(q.corner[1]), part(q.corner[2])}};
}
MovingEdgeEdge during(const MovingEdgeEdge& q, double low, double high) {
  const auto part = [=](const MovingPoint& p) { return during(p, low, high); };
  return {{part(q.first[0]), part(q.first[1])}, {part(q.second[0]), part(q.second[1])}};
}

// What the search has found; "apart" until something touches.
struct FirstTouch {
  Answer answer{Verdict::apart, 0};

  // Returns true when the search is over.
  bool offer(Touch found, double earliest) {
    if (found == Touch::no) return false;
    answer = {found == Touch::yes ? Verdict::contact : Verdict::undecided, earliest};
    return true;
  }
};

// Both ends, and at most two roots for each of four lines and one for each of three axes of four pairs.
struct Times {
  std::array<double, 22> at{};
  std::size_t count = 0;
  void add(double t) {
    if (t >= 0 && t <= 1) at[count++] = t;
  }
};

// When p is on the line ab: the roots of twice the signed area of (a, b, p), a quadratic in Bernstein form,
// projected along the axis that shows most of it.
void add_crossings(const MovingPoint& a, const MovingPoint& b, const MovingPoint& p, Times& times) {
  const MovingVector ab = difference(a, b), ap = difference(a, p);
  const Vec3 area[3] = {ab.start.cross(ap.start), (ab.start.cross(ap.end) + ab.end.cross(ap.start)) / 2,
                        ab.end.cross(ap.end)};
  int axis = 0;
  (area[0].cwiseAbs() + area[1].cwiseAbs() + area[2].cwiseAbs()).maxCoeff(&axis);
  const double c0 = area[0][axis], c1 = area[1][axis], c2 = area[2][axis];
  const double square = c0 - 2 * c1 + c2, half_b = c1 - c0;
  const double discriminant = std::max(0.0, half_b * half_b - square * c0);
  const double q = -(half_b + std::copysign(std::sqrt(discriminant), half_b));
  times.add(q / square);
  times.add(c0 / q);
}

// When p and q have a coordinate in common: for what moves along one line, where nothing crosses a line.
void add_meetings(const MovingPoint& p, const MovingPoint& q, Times& times) {
  for (int axis = 0; axis < 3; ++axis) {
    const double start = q.start[axis] - p.start[axis], end = q.end[axis] - p.end[axis];
    times.add(start / (start - end));
  }
}

// Coplanar throughout: features can begin to touch only at t = 0 or when a point crosses the line of an edge,
// or, on one line, meets another point.
void add_events(const MovingVertexFace& q, Times& times) {
  for (int k = 0; k < 3; ++k) {
    add_crossings(q.corner[k], q.corner[(k + 1) % 3], q.vertex, times);
    add_meetings(q.corner[k], q.vertex, times);
  }
}
void add_events(const MovingEdgeEdge& q, Times& times) {
  for (int k = 0; k < 2; ++k) {
    add_crossings(q.first[0], q.first[1], q.second[k], times);
    add_crossings(q.second[0], q.second[1], q.first[k], times);
    for (int l = 0; l < 2; ++l) add_meetings(q.first[k], q.second[l], times);
  }
}

template <class Query>
Answer planar(const Query& query) {
  if (relative_boxes_apart(query)) return {Verdict::apart, 0};
  Times times;
  times.add(0);
  times.add(1);  // a root there may be rounded past it
  add_events(query, times);
  std::sort(times.at.begin(), times.at.begin() + times.count);
  FirstTouch search;
  for (std::size_t i = 0; i < times.count; ++i)
    if (search.offer(touch(query, times.at[i]), times.at[i])) break;
  return search.answer;
}

// The same when all that is known is that they may be in one plane between two times, near a double root
// mostly. "No" only where one border keeps them apart by more than its margin changes, or where parallel
// features stay apart as if they were in one plane throughout.
template <class Query>
Touch touch_between(const Query& q, double low, double high) {
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

// Polar form of the cubic: its control points on [a, b] are blossom(a,a,a), (a,a,b), (a,b,b), (b,b,b).
double blossom(const double (&c)[4], double r, double s, double t) {
  const auto mix = [](double x, double y, double w) { return (1 - w) * x + w * y; };
  const double d0 = mix(c[0], c[1], r), d1 = mix(c[1], c[2], r), d2 = mix(c[2], c[3], r);
  return mix(mix(d0, d1, s), mix(d1, d2, s), t);
}

// Visits enclosures of the roots in [low, high] in ascending order until one ends the search.
template <class Query>
bool search_roots(const Query& query, const BernsteinCubic& f, double low, double high, FirstTouch& search) {
  while (true) {
    const double control[4] = {blossom(f.c, low, low, low), blossom(f.c, low, low, high),
                               blossom(f.c, low, high, high), blossom(f.c, high, high, high)};
    const auto [least, most] = std::minmax({control[0], control[1], control[2], control[3]});
    if (least > f.error || most < -f.error) return false;
    // Narrow enough, or flat within rounding: no cut tells more about where the root is.
    if (high - low <= kRootWidth) return search.offer(touch(query, (low + high) / 2), low);
    if (least >= -f.error && most <= f.error) return search.offer(touch_between(query, low, high), low);

    // The derivative's range on [low, high], from its own control points.
    const double scale = 3 / (high - low);
    const auto [slope_least, slope_most] =
        std::minmax({scale * (control[1] - control[0]), scale * (control[2] - control[1]),
                     scale * (control[3] - control[2])});
    const double middle = (low + high) / 2;
    double new_low = low, new_high = high;
    if (slope_least > 0 || slope_most < 0) {
      const double value = blossom(f.c, middle, middle, middle);
      const double pad = f.error / std::min(std::abs(slope_least), std::abs(slope_most));
      const double r = middle - value / slope_least, s = middle - value / slope_most;
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

template <class Query>
Answer newton(const Query& query) {
  const BernsteinCubic f = coplanarity(query);
  if (certain_sign(f) != 0) return {Verdict::apart, 0};
  if (!std::isfinite(f.error)) return {relative_boxes_apart(query) ? Verdict::apart : Verdict::undecided, 0};
  const auto [least, most] = std::minmax({f.c[0], f.c[1], f.c[2], f.c[3]});
  if (least >= -f.error && most <= f.error) return planar(query);
  FirstTouch search;
  search_roots(query, f, 0, 1, search);
  return search.answer;
}

}  // namespace

Answer newton_vertex_face(const MovingVertexFace& query) {
  return newton(query);
}
Answer newton_edge_edge(const MovingEdgeEdge& query) {
  return newton(query);
}

}  // namespace cscd
