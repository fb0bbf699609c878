#include <algorithm>
#include <cmath>

#include "core/elementary/published.h"
#include "core/elementary/question/filter.h"
#include "core/elementary/question/query_scale.h"
#include "core/geometry/feature_distance.h"

// Finds the roots of the coplanarity cubic and measures the distance of the features at each root (Provot,
// "Collision and self-collision handling in cloth model dedicated to design garments", 1997; Bridson,
// Fedkiw and Anderson, "Robust treatment of collisions, contact and friction for cloth animation", SIGGRAPH
// 2002, section 7.1).
//
// The turning points of the cubic cut [0, 1] into at most three monotone pieces. Each piece is closed. A
// change of sign within a piece gives a root, and the distance is measured at the ends of the piece in any
// case. So double roots, and roots at 0 and 1, survive rounding.
//
// There are three differences to the papers: the cubic is in Bernstein form, the filter in front is
// certified, and the tolerance is relative to the query.
//
// An "apart" is a proof only if it comes from the filter. The distances behind any other "apart" are
// measured at rounded roots, and features that stay in one plane are measured at both ends only, as in the
// papers.
namespace cscd {
namespace {

// The times in (0, 1) at which the derivative of the cubic is zero, in ascending order. If there are fewer
// than two such times, 0, 1 or the same time again fills the gap.
struct TurningPoints {
  double first = 0, second = 1;

  explicit TurningPoints(const BernsteinCubic& f) {
    const double d0 = f.c[1] - f.c[0], d1 = f.c[2] - f.c[1], d2 = f.c[3] - f.c[2];
    const double square = d0 - 2 * d1 + d2, half_b = d1 - d0;
    const double q =
        -(half_b + std::copysign(std::sqrt(std::max(0.0, half_b * half_b - square * d0)), half_b));
    const auto inside = [](double t) { return t > 0 && t < 1; };
    const double r = q / square, s = d0 / q;  // if NaN or infinite, not inside
    first = inside(r) ? r : inside(s) ? s : 0;
    second = inside(s) ? s : 1;
    if (first > second) std::swap(first, second);
  }
};

// The root in a monotone piece with a change of sign, by Newton's iteration. Bisection replaces each step
// that would leave the bracket.
double root_between(const BernsteinCubic& f, double low, double high) {
  const bool rising = f.at(low) < 0;
  double t = (low + high) / 2;
  for (int i = 0; i < 64 && high - low > 0x1p-50; ++i) {
    const double value = f.at(t);
    if (value == 0) return t;
    ((value < 0) == rising ? low : high) = t;
    const double s = 1 - t;
    const double slope =
        3 * (s * s * (f.c[1] - f.c[0]) + 2 * s * t * (f.c[2] - f.c[1]) + t * t * (f.c[3] - f.c[2]));
    const double next = t - value / slope;
    const bool useful = next > low && next < high;
    if (useful && std::abs(next - t) <= 0x1p-52) return next;
    t = useful ? next : (low + high) / 2;
  }
  return t;
}

template <class Query>
Answer cubic(const Query& given, const TestParameters& parameters) {
  const Query scaled = in_range(given);
  const BernsteinCubic f = coplanarity(scaled);
  if (certain_sign(f) != 0) return {Verdict::apart, 0};
  const Query query = relative(scaled);
  const double near = parameters.tolerance * extent(query);
  const auto touch = [&](double t) { return distance_at(query, t) <= near; };

  if (touch(0)) return {Verdict::contact, 0};
  const TurningPoints turning(f);
  double low = 0;
  for (const double high : {turning.first, turning.second, 1.0}) {
    if (high <= low) continue;
    if ((f.at(low) < 0) != (f.at(high) < 0)) {
      const double root = root_between(f, low, high);
      if (touch(root)) return {Verdict::contact, root};
    }
    if (touch(high)) return {Verdict::contact, high};
    low = high;
  }
  return {Verdict::apart, 0};
}

}  // namespace

Answer cubic_vertex_face(const MovingVertexFace& query, const TestParameters& parameters) {
  return cubic(query, parameters);
}
Answer cubic_edge_edge(const MovingEdgeEdge& query, const TestParameters& parameters) {
  return cubic(query, parameters);
}

}  // namespace cscd
