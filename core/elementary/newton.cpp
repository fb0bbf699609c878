#include "core/elementary/newton.h"

#include <algorithm>
#include <array>
#include <cmath>

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

// Is the point, known to be in the plane, inside the triangle at time t?
Touch touch(const MovingVertexFace& q, double t) {
  const Vec3 a = q.corner[0].at(t), ab = q.corner[1].at(t) - a, ac = q.corner[2].at(t) - a,
             av = q.vertex.at(t) - a;
  const Vec3 n = ab.cross(ac);
  const double area = n.squaredNorm();
  if (!(area > kParallel * kParallel * ab.squaredNorm() * ac.squaredNorm())) {
    // Hardly more than its edges.
    const Vec3 v = q.vertex.at(t);
    return near_segment(v, a, ab) || near_segment(v, a, ac) || near_segment(v, a + ab, ac - ab)
               ? Touch::unclear
               : Touch::no;
  }
  const double u = av.cross(ac).dot(n) / area, v = ab.cross(av).dot(n) / area;
  return u >= -kInside && v >= -kInside && u + v <= 1 + kInside ? Touch::yes : Touch::no;
}

// Do two segments, known to be in one plane, cross at time t?
Touch touch(const MovingEdgeEdge& q, double t) {
  const Vec3 a = q.first[0].at(t), ab = q.first[1].at(t) - a, c = q.second[0].at(t),
             cd = q.second[1].at(t) - c;
  const Vec3 n = ab.cross(cd), ac = c - a;
  const double area = n.squaredNorm();
  if (!(area > kParallel * kParallel * ab.squaredNorm() * cd.squaredNorm())) {
    // Parallel segments are nearest to each other at an end.
    const bool near = near_segment(a, c, cd) || near_segment(a + ab, c, cd) || near_segment(c, a, ab) ||
                      near_segment(c + cd, a, ab);
    return near ? Touch::unclear : Touch::no;
  }
  const double u = ac.cross(cd).dot(n) / area, v = ac.cross(ab).dot(n) / area;
  return u >= -kInside && u <= 1 + kInside && v >= -kInside && v <= 1 + kInside ? Touch::yes : Touch::no;
}

// The first time at which `touches` says yes or unclear among those offered in ascending order.
template <class Query>
struct FirstTouch {
  const Query& query;
  Answer answer{Verdict::apart, 0};

  // Returns true when the search is over.
  bool offer(double t, double earliest) {
    const Touch found = touch(query, t);
    if (found == Touch::no) return false;
    answer = {found == Touch::yes ? Verdict::contact : Verdict::undecided, earliest};
    return true;
  }
};

// Polar form of the cubic: its control points on [a, b] are blossom(a,a,a), (a,a,b), (a,b,b), (b,b,b).
double blossom(const double (&c)[4], double r, double s, double t) {
  const auto mix = [](double x, double y, double w) { return (1 - w) * x + w * y; };
  const double d0 = mix(c[0], c[1], r), d1 = mix(c[1], c[2], r), d2 = mix(c[2], c[3], r);
  return mix(mix(d0, d1, s), mix(d1, d2, s), t);
}

// Visits enclosures of the roots in [low, high] in ascending order until one ends the search.
template <class Query>
bool search_roots(const BernsteinCubic& f, double low, double high, FirstTouch<Query>& search) {
  while (true) {
    const double control[4] = {blossom(f.c, low, low, low), blossom(f.c, low, low, high),
                               blossom(f.c, low, high, high), blossom(f.c, high, high, high)};
    const auto [least, most] = std::minmax({control[0], control[1], control[2], control[3]});
    if (least > f.error || most < -f.error) return false;
    // Narrow enough, or flat within rounding: no cut tells more about where the root is.
    if (high - low <= kRootWidth) return search.offer((low + high) / 2, low);
    if (least >= -f.error && most <= f.error)
      return search.offer(low, low) || search.offer((low + high) / 2, low) || search.offer(high, low);

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
    if (search_roots(f, low, middle, search)) return true;
    low = middle;
  }
}

// Signed area of (a, b, p) projected along `axis`, as a quadratic in t in Bernstein form.
std::array<double, 3> signed_area(const MovingPoint& a, const MovingPoint& b, const MovingPoint& p,
                                  int axis) {
  const MovingVector ab = difference(a, b), ap = difference(a, p);
  const auto cross = [axis](const Vec3& x, const Vec3& y) { return x.cross(y)[axis]; };
  return {cross(ab.start, ap.start), (cross(ab.start, ap.end) + cross(ab.end, ap.start)) / 2,
          cross(ab.end, ap.end)};
}

// At most t = 0 and two roots for each of four lines.
struct Times {
  std::array<double, 9> at{};
  std::size_t count = 0;
  void add(double t) { at[count++] = t; }
};

// The roots of the quadratic that lie in [0, 1].
void add_roots(const std::array<double, 3>& c, Times& times) {
  const double a = c[0] - 2 * c[1] + c[2], half_b = c[1] - c[0];
  const double discriminant = std::max(0.0, half_b * half_b - a * c[0]);
  const double q = -(half_b + std::copysign(std::sqrt(discriminant), half_b));
  for (const double root : {q / a, c[0] / q})
    if (root >= 0 && root <= 1) times.add(root);
}

// Coplanar throughout: features can begin to touch only at t = 0 or when a point crosses the line of an edge.
template <class Query>
Answer planar(const Query& query, const Vec3& normal,
              std::initializer_list<std::array<const MovingPoint*, 3>> lines) {
  int axis = 0;
  normal.cwiseAbs().maxCoeff(&axis);
  Times times;
  times.add(0);
  for (const auto& [a, b, p] : lines) add_roots(signed_area(*a, *b, *p, axis), times);
  std::sort(times.at.begin(), times.at.begin() + times.count);
  FirstTouch<Query> search{query};
  for (std::size_t i = 0; i < times.count; ++i)
    if (search.offer(times.at[i], times.at[i])) break;
  return search.answer;
}

Answer planar(const MovingVertexFace& q) {
  if (relative_boxes_apart(q)) return {Verdict::apart, 0};
  const MovingVector ab = difference(q.corner[0], q.corner[1]), ac = difference(q.corner[0], q.corner[2]);
  return planar(q, ab.start.cross(ac.start) + ab.end.cross(ac.end),
                {{&q.corner[0], &q.corner[1], &q.vertex},
                 {&q.corner[1], &q.corner[2], &q.vertex},
                 {&q.corner[2], &q.corner[0], &q.vertex}});
}

Answer planar(const MovingEdgeEdge& q) {
  if (relative_boxes_apart(q)) return {Verdict::apart, 0};
  const MovingVector ab = difference(q.first[0], q.first[1]), cd = difference(q.second[0], q.second[1]);
  return planar(q, ab.start.cross(cd.start) + ab.end.cross(cd.end),
                {{&q.first[0], &q.first[1], &q.second[0]},
                 {&q.first[0], &q.first[1], &q.second[1]},
                 {&q.second[0], &q.second[1], &q.first[0]},
                 {&q.second[0], &q.second[1], &q.first[1]}});
}

template <class Query>
Answer newton(const Query& query) {
  const BernsteinCubic f = coplanarity(query);
  if (certain_sign(f) != 0) return {Verdict::apart, 0};
  if (!std::isfinite(f.error)) return {Verdict::undecided, 0};
  const auto [least, most] = std::minmax({f.c[0], f.c[1], f.c[2], f.c[3]});
  if (least >= -f.error && most <= f.error) return planar(query);
  FirstTouch<Query> search{query};
  search_roots(f, 0, 1, search);
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
