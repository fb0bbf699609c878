#include "scenes/character/transform.h"

#include <cmath>

#include "scenes/shape/circle.h"

namespace cscd::scenes {
namespace {

double dot(const Quaternion& a, const Quaternion& b) {
  return a.w * b.w + a.x * b.x + a.y * b.y + a.z * b.z;
}

Quaternion weighted(double s, const Quaternion& a, double t, const Quaternion& b) {
  return {s * a.w + t * b.w, s * a.x + t * b.x, s * a.y + t * b.y, s * a.z + t * b.z};
}

std::array<Vec3, 3> columns_of(const Quaternion& q) {
  return {Vec3(1 - 2 * (q.y * q.y + q.z * q.z), 2 * (q.x * q.y + q.w * q.z), 2 * (q.x * q.z - q.w * q.y)),
          Vec3(2 * (q.x * q.y - q.w * q.z), 1 - 2 * (q.x * q.x + q.z * q.z), 2 * (q.y * q.z + q.w * q.x)),
          Vec3(2 * (q.x * q.z + q.w * q.y), 2 * (q.y * q.z - q.w * q.x), 1 - 2 * (q.x * q.x + q.y * q.y))};
}

// The quaternion of a rotation given by its columns (Shepperd 1978). A square root gives the largest of the
// four numbers, and the others follow from it.
Quaternion quaternion_of(const std::array<Vec3, 3>& c) {
  const double trace = c[0].x() + c[1].y() + c[2].z();
  Quaternion q;
  if (trace > 0) {
    q = {1 + trace, c[1].z() - c[2].y(), c[2].x() - c[0].z(), c[0].y() - c[1].x()};
  } else if (c[0].x() >= c[1].y() && c[0].x() >= c[2].z()) {
    q = {c[1].z() - c[2].y(), 1 + c[0].x() - c[1].y() - c[2].z(), c[0].y() + c[1].x(), c[2].x() + c[0].z()};
  } else if (c[1].y() >= c[2].z()) {
    q = {c[2].x() - c[0].z(), c[0].y() + c[1].x(), 1 + c[1].y() - c[0].x() - c[2].z(), c[1].z() + c[2].y()};
  } else {
    q = {c[0].y() - c[1].x(), c[2].x() + c[0].z(), c[1].z() + c[2].y(), 1 + c[2].z() - c[0].x() - c[1].y()};
  }
  return normalised(q);
}

// Returns some direction at a right angle to `unit`.
Vec3 across(const Vec3& unit) {
  const Vec3 other = std::abs(unit.x()) < 0.5 ? Vec3::UnitX() : Vec3::UnitY();
  return unit.cross(other);
}

}  // namespace

bool Transform::finite() const {
  return column[0].allFinite() && column[1].allFinite() && column[2].allFinite() && origin.allFinite();
}

Transform composed(const Transform& after, const Transform& before) {
  Transform both;
  for (std::size_t i = 0; i < 3; ++i) both.column[i] = after.direction(before.column[i]);
  both.origin = after(before.origin);
  return both;
}

Transform inverse(const Transform& map) {
  const auto& c = map.column;
  const double determinant = map.determinant();
  const Vec3 row[3] = {c[1].cross(c[2]) / determinant, c[2].cross(c[0]) / determinant,
                       c[0].cross(c[1]) / determinant};
  Transform back;
  for (int i = 0; i < 3; ++i) back.column[static_cast<std::size_t>(i)] = {row[0][i], row[1][i], row[2][i]};
  back.origin = -back.direction(map.origin);
  return back;
}

Quaternion normalised(const Quaternion& q) {
  const double length = std::sqrt(dot(q, q));
  if (!(length > 0) || !std::isfinite(length)) return {};
  return {q.w / length, q.x / length, q.y / length, q.z / length};
}

Quaternion product(const Quaternion& after, const Quaternion& before) {
  const Quaternion &p = after, &q = before;
  return {p.w * q.w - p.x * q.x - p.y * q.y - p.z * q.z, p.w * q.x + p.x * q.w + p.y * q.z - p.z * q.y,
          p.w * q.y - p.x * q.z + p.y * q.w + p.z * q.x, p.w * q.z + p.x * q.y - p.y * q.x + p.z * q.w};
}

Quaternion slerp(const Quaternion& a, const Quaternion& b, double s) {
  Quaternion low = a, high = dot(a, b) < 0 ? weighted(-1, b, 0, b) : b;
  // The normalised sum of both ends is exactly half-way. After k halvings an arc of at most 90 degrees
  // (between quaternions) has 90 / 2^k left, and its chord strays from the arc by the cube of that.
  for (int halvings = 0; halvings < 14 && s > 0 && s < 1; ++halvings) {
    const Quaternion middle = normalised(weighted(1, low, 1, high));
    (s < 0.5 ? high : low) = middle;
    s = s < 0.5 ? 2 * s : 2 * s - 1;
  }
  return normalised(weighted(1 - s, low, s, high));
}

Quaternion from_euler(const Vec3& degrees, const std::array<int, 3>& order) {
  Quaternion q;
  for (const int axis : order) {
    const CirclePoint half = circle_point(degrees[axis] / 720);
    Quaternion turn{half.cosine, 0, 0, 0};
    (axis == 0 ? turn.x : axis == 1 ? turn.y : turn.z) = half.sine;
    q = product(turn, q);
  }
  return normalised(q);
}

Transform from_trs(const Vec3& move, const Quaternion& rotation, const Vec3& scale) {
  Transform map;
  map.column = columns_of(rotation);
  for (int i = 0; i < 3; ++i) map.column[static_cast<std::size_t>(i)] *= scale[i];
  map.origin = move;
  return map;
}

Trs trs_of(const Transform& map) {
  // Gram-Schmidt orthogonalisation. A column that has no direction of its own gets one at a right angle.
  const auto& c = map.column;
  std::array<Vec3, 3> axis;
  const double first = c[0].norm();
  axis[0] = first > 0 ? Vec3(c[0] / first) : Vec3::UnitX();
  Vec3 second = c[1] - axis[0].dot(c[1]) * axis[0];
  if (!(second.norm() > 1e-12 * c[1].norm())) second = across(axis[0]);
  axis[1] = second / second.norm();
  axis[2] = axis[0].cross(axis[1]);
  Trs parts{map.origin, quaternion_of(axis), {}};
  // Take `rest` from the columns of the rounded quaternion, so that rotation and rest together give the map
  // however the quaternion was rounded.
  const std::array<Vec3, 3> rotation = columns_of(parts.rotation);
  for (std::size_t i = 0; i < 3; ++i)
    parts.rest[i] = {rotation[0].dot(c[i]), rotation[1].dot(c[i]), rotation[2].dot(c[i])};
  return parts;
}

Transform blend(const Transform& a, const Transform& b, double s) {
  if (s <= 0) return a;
  if (s >= 1) return b;
  const Trs from = trs_of(a), to = trs_of(b);
  Transform rotation, rest;
  rotation.column = columns_of(slerp(from.rotation, to.rotation, s));
  for (std::size_t i = 0; i < 3; ++i) rest.column[i] = (1 - s) * from.rest[i] + s * to.rest[i];
  Transform map = composed(rotation, rest);
  map.origin = (1 - s) * from.move + s * to.move;
  return map;
}

}  // namespace cscd::scenes
