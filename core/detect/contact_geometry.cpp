#include "core/detect/contact_geometry.h"

#include <algorithm>
#include <cmath>

#include "core/geometry/feature_motion.h"
#include "core/geometry/unit_scale.h"

namespace cscd {
namespace {

// A cross product that is shorter than this share of the lengths that made it consists of rounding.
constexpr double kParallel = 1e-9;

// A point of a feature.
struct Located {
  Vec3 at, start, velocity;  // position at contact; position at the start; way over the interval
};

Located weighted(const MovingPoint* points, const double* weights, int count, double time) {
  Located sum{Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
  for (int i = 0; i < count; ++i) {
    sum.at += weights[i] * points[i].at(time);
    sum.start += weights[i] * points[i].start;
    sum.velocity += weights[i] * (points[i].end - points[i].start);
  }
  return sum;
}

// Returns where on a segment the point nearest to `point` lies, as a share of the way in [0, 1].
double share_along(const Vec3& from, const Vec3& to, const Vec3& point) {
  const Vec3 way = to - from;
  const double length = way.squaredNorm();
  return length > 0 ? std::clamp(way.dot(point - from) / length, 0.0, 1.0) : 0.0;
}

// Returns the barycentric weights of the point of a triangle that is nearest to p (Ericson,
// Real-Time Collision Detection, 2005, section 5.1.5). If p projects outside the face, the
// nearest point of a side is taken.
std::array<double, 3> nearest_weights(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 n = (b - a).cross(c - a);
  const double area = n.squaredNorm();
  const double longest = std::max({(b - a).squaredNorm(), (c - a).squaredNorm(), (c - b).squaredNorm()});
  if (area > kParallel * kParallel * longest * longest) {
    const std::array<double, 3> w = {n.dot((c - b).cross(p - b)) / area, n.dot((a - c).cross(p - c)) / area,
                                     n.dot((b - a).cross(p - a)) / area};
    if (w[0] >= 0 && w[1] >= 0 && w[2] >= 0) {
      const double sum = w[0] + w[1] + w[2];
      return {w[0] / sum, w[1] / sum, w[2] / sum};
    }
  }
  const double ab = share_along(a, b, p), bc = share_along(b, c, p), ca = share_along(c, a, p);
  const std::array<std::array<double, 3>, 3> on_side = {{{1 - ab, ab, 0}, {0, 1 - bc, bc}, {ca, 0, 1 - ca}}};
  return *std::min_element(on_side.begin(), on_side.end(), [&](const auto& u, const auto& v) {
    const auto distance = [&](const auto& w) { return (w[0] * a + w[1] * b + w[2] * c - p).squaredNorm(); };
    return distance(u) < distance(v);
  });
}

// Returns the shares along the segments p q and r s at their nearest points (Ericson, section 5.1.9).
std::array<double, 2> nearest_shares(const Vec3& p, const Vec3& q, const Vec3& r, const Vec3& s) {
  const Vec3 u = q - p, v = s - r, w = p - r;
  const double a = u.squaredNorm(), b = u.dot(v), e = v.squaredNorm(), c = u.dot(w), f = v.dot(w);
  const double area = a * e - b * b;
  double first = area > kParallel * kParallel * a * e ? std::clamp((b * f - c * e) / area, 0.0, 1.0) : 0.0;
  const double second = share_along(r, s, p + first * u);
  first = share_along(p, q, r + second * v);
  return {first, second};
}

// The normal of features that are apart leads along their nearest points. Returns whether there is one.
bool set_normal_between(const Located& first, const Located& second, ContactGeometry& out) {
  const Vec3 way = first.at - second.at;
  const double length = stable_length(way);
  if (!(length > 0) || !std::isfinite(length)) return false;
  out.normal = way / length;
  out.relative_speed = out.normal->dot(first.velocity - second.velocity);
  return true;
}

// Sets the normal and the relative speed. The normal points to the side from which the first feature came:
// that is against its motion, or, if it does not move along `direction`, to where it stood at the start. If
// `direction` is too short for its `scale`, the line between the starting points is taken instead.
void set_normal(Vec3 direction, double scale, const Located& first, const Located& second,
                ContactGeometry& out) {
  const Vec3 apart = first.start - second.start, velocity = first.velocity - second.velocity;
  const double length = direction.norm();
  if (length > kParallel * scale) {
    direction /= length;
  } else {
    const double distance = apart.norm();
    if (!(distance > 0) || !std::isfinite(distance)) return;
    direction = apart / distance;
  }
  if (!direction.allFinite()) return;
  double speed = direction.dot(velocity);
  const double side = std::abs(speed) > kParallel * velocity.norm() ? -speed : direction.dot(apart);
  if (side < 0) {
    direction = -direction;
    speed = -speed;
  }
  out.normal = direction;
  out.relative_speed = speed;
}

ContactGeometry of(const MovingVertexFace& q, double time, bool at_distance) {
  const Vec3 p = q.vertex.at(time), a = q.corner[0].at(time), b = q.corner[1].at(time),
             c = q.corner[2].at(time);
  ContactGeometry out;
  out.point = p;
  out.weights = nearest_weights(p, a, b, c);
  out.weight_count = 3;
  const double whole = 1;
  const Located first = weighted(&q.vertex, &whole, 1, time);
  const Located second = weighted(q.corner, out.weights.data(), 3, time);
  const double longest = std::max({(b - a).norm(), (c - a).norm(), (c - b).norm()});
  if (at_distance && set_normal_between(first, second, out)) return out;
  set_normal((b - a).cross(c - a), longest * longest, first, second, out);
  return out;
}

ContactGeometry of(const MovingEdgeEdge& q, double time, bool at_distance) {
  const Vec3 p = q.first[0].at(time), u = q.first[1].at(time) - p;
  const Vec3 r = q.second[0].at(time), v = q.second[1].at(time) - r;
  const std::array<double, 2> shares = nearest_shares(p, p + u, r, r + v);
  ContactGeometry out;
  out.weights = {shares[0], shares[1], 0};
  out.weight_count = 2;
  const double on_first[2] = {1 - shares[0], shares[0]}, on_second[2] = {1 - shares[1], shares[1]};
  const Located first = weighted(q.first, on_first, 2, time), second = weighted(q.second, on_second, 2, time);
  out.point = first.at;
  if (at_distance && set_normal_between(first, second, out)) return out;
  set_normal(u.cross(v), u.norm() * v.norm(), first, second, out);
  return out;
}

}  // namespace

std::array<VertexId, 4> vertices_of(const TriangleMesh& mesh, const FeaturePair& pair) {
  if (pair.kind == FeaturePair::Kind::vertex_face) {
    const Triangle& face = mesh.corners(TriangleId{pair.b});
    return {VertexId{pair.a}, face[0], face[1], face[2]};
  }
  const Edge &first = mesh.ends(EdgeId{pair.a}), &second = mesh.ends(EdgeId{pair.b});
  return {first[0], first[1], second[0], second[1]};
}

// The formulas multiply up to four lengths, so they are applied in the scale in which coordinates are
// about 1.
ContactGeometry contact_geometry(const TriangleMesh& mesh, const Motion& motion, const FeaturePair& pair,
                                 double time, bool at_distance) {
  const std::array<VertexId, 4> vertices = vertices_of(mesh, pair);
  double largest = 0;
  for (const VertexId v : vertices)
    largest = std::max({largest, motion[v].start.cwiseAbs().maxCoeff(), motion[v].end.cwiseAbs().maxCoeff()});
  const double scale = unit_scale(largest);
  std::array<MovingPoint, 4> p;
  for (std::size_t i = 0; i < 4; ++i)
    p[i] = {scale * motion[vertices[i]].start, scale * motion[vertices[i]].end};
  ContactGeometry out =
      pair.kind == FeaturePair::Kind::vertex_face
          ? of(MovingVertexFace{.vertex = p[0], .corner = {p[1], p[2], p[3]}}, time, at_distance)
          : of(MovingEdgeEdge{.first = {p[0], p[1]}, .second = {p[2], p[3]}}, time, at_distance);
  out.point /= scale;
  if (out.relative_speed) *out.relative_speed /= scale;
  return out;
}

}  // namespace cscd
