#include <algorithm>
#include <cmath>

#include "core/elementary/published.h"
#include "core/elementary/question/filter.h"
#include "core/elementary/question/query_scale.h"
#include "core/geometry/feature_distance.h"

// Additive continuous collision detection (Li, Kaufman and Jiang, "Codimensional incremental potential
// contact", SIGGRAPH 2021, section 5). This is conservative advancement: the bound on the speed of approach
// is the sum of the largest displacements of the two features, after the mean displacement has been
// subtracted.
//
// Each step advances time by 0.9 of the distance over that bound; in this time the features cannot meet. The
// steps end when the distance has fallen to a share of the distance at the start; the last step is not taken.
//
// There are three differences to the paper. The share is a parameter of its own, where the paper uses one
// number for the share and for the step. A certified filter stands in front. A limit on the number of steps
// ends in `undecided`, where the paper runs on.
//
// At a distance r, the paper's minimum separation, the distance less r takes the place of the distance, and
// no filter stands in front.
//
// An "apart" would be a proof in exact arithmetic. It is none here, because the distances of nearly
// degenerate features may be rounded upwards. A "contact" may be false: it may be features that come to
// within the share of their starting distance.
namespace cscd {
namespace {

constexpr double kStep = 0.9;

template <std::size_t N>
double largest_displacement(const MovingPoint (&points)[N], const Vec3& mean) {
  double largest = 0;
  for (const MovingPoint& p : points) largest = std::max(largest, (p.end - p.start - mean).squaredNorm());
  return std::sqrt(largest);
}
template <class Query>
Vec3 mean_displacement(const Query& q) {
  Vec3 sum = Vec3::Zero();
  for_each_point(q, [&](const MovingPoint& p) { sum += p.end - p.start; });
  return sum / 4;
}
double approach(const MovingVertexFace& q) {
  const Vec3 mean = mean_displacement(q);
  return (q.vertex.end - q.vertex.start - mean).norm() + largest_displacement(q.corner, mean);
}
double approach(const MovingEdgeEdge& q) {
  const Vec3 mean = mean_displacement(q);
  return largest_displacement(q.first, mean) + largest_displacement(q.second, mean);
}

template <class Query>
Answer additive(const Query& given, double r, const TestParameters& parameters) {
  if (r == 0 && never_coplanar(given)) return {Verdict::apart, 0};
  const Query query = relative(in_range(given));
  r = std::ldexp(r, range_exponent(given));
  double distance = distance_at(query, 0) - r;
  if (distance <= 0) return {Verdict::contact, 0};
  const double speed = approach(query), near = parameters.tolerance * distance;
  double time = 0, step = (1 - parameters.tolerance) * distance / speed;
  for (std::int64_t i = 0; i < parameters.steps; ++i) {
    const double next = time + std::min(step, kStep * distance / speed);
    if (!(next <= 1)) return {Verdict::apart, 0};  // `next` is infinite or NaN if nothing moves
    distance = distance_at(query, next) - r;
    if (distance <= near) return {Verdict::contact, time};
    time = next;
    step = kStep * distance / speed;
  }
  return {Verdict::undecided, time};
}

}  // namespace

Answer additive_vertex_face(const MovingVertexFace& query, const TestParameters& parameters) {
  return additive(query, 0, parameters);
}
Answer additive_edge_edge(const MovingEdgeEdge& query, const TestParameters& parameters) {
  return additive(query, 0, parameters);
}
Answer additive_vertex_face_close(const MovingVertexFace& query, double r, const TestParameters& parameters) {
  return additive(query, r, parameters);
}
Answer additive_edge_edge_close(const MovingEdgeEdge& query, double r, const TestParameters& parameters) {
  return additive(query, r, parameters);
}

}  // namespace cscd
