#include "scenes/hard/disturbance.h"

#include <cmath>
#include <span>
#include <utility>

#include "core/base/digest.h"
#include "core/elementary/question/query_scale.h"

namespace cscd::scenes::hard {
namespace {

template <class Map>
void map_coordinates(Query& query, const Map& map) {
  for (MovingPoint& p : query.points)
    for (Vec3* x : {&p.start, &p.end})
      for (int axis = 0; axis < 3; ++axis) (*x)[axis] = map((*x)[axis]);
}
template <class Map>
void map_points(Query& query, const Map& map) {
  for (MovingPoint& p : query.points) p = {map(p.start), map(p.end)};
}

// Turns about an axis by 90 degrees, or by the angle with cosine 3/5 and sine 4/5 while scaling by 5.
void turn_exactly(Query& query, Random& random) {
  const int axis = random.integer(0, 2), y = (axis + 1) % 3, z = (axis + 2) % 3;
  const bool quarter = random.integer(0, 1) == 1;
  const double c = quarter ? 0 : 3, s = quarter ? 1 : 4, whole = quarter ? 1 : 5;
  map_points(query, [&](const Vec3& p) {
    Vec3 q;
    q[axis] = whole * p[axis];
    q[y] = c * p[y] - s * p[z];
    q[z] = s * p[y] + c * p[z];
    return q;
  });
}

// Turns by a random quaternion of integers.
void turn_anyhow(Query& query, Random& random) {
  const double a = random.integer(1, 9), b = random.integer(-9, 9), c = random.integer(-9, 9),
               d = random.integer(-9, 9), norm = a * a + b * b + c * c + d * d;
  const Vec3 x = Vec3(a * a + b * b - c * c - d * d, 2 * (b * c + a * d), 2 * (b * d - a * c)) / norm;
  const Vec3 y = Vec3(2 * (b * c - a * d), a * a - b * b + c * c - d * d, 2 * (c * d + a * b)) / norm;
  const Vec3 z = Vec3(2 * (b * d + a * c), 2 * (c * d - a * b), a * a - b * b - c * c + d * d) / norm;
  map_points(query, [&](const Vec3& p) {
    Vec3 q;
    for (int axis = 0; axis < 3; ++axis) q[axis] = x[axis] * p.x() + y[axis] * p.y() + z[axis] * p.z();
    return q;
  });
}

void permute(Query& query, Kind kind, Random& random) {
  auto& p = query.points;
  if (kind == Kind::vertex_face) {
    std::swap(p[1], p[static_cast<std::size_t>(random.integer(1, 3))]);
    std::swap(p[2], p[static_cast<std::size_t>(random.integer(2, 3))]);
    return;
  }
  if (random.integer(0, 1)) std::swap(p[0], p[1]);
  if (random.integer(0, 1)) std::swap(p[2], p[3]);
  if (random.integer(0, 1)) std::swap(p[0], p[2]), std::swap(p[1], p[3]);
}

double off_by_ulps(double x, int ulps, Random& random) {
  int steps = random.integer(-ulps, ulps);
  if (std::abs(steps) <= 64) {
    for (; steps > 0; --steps) x = std::nextafter(x, HUGE_VAL);
    for (; steps < 0; ++steps) x = std::nextafter(x, -HUGE_VAL);
    return x;
  }
  return x + steps * (0x1p-53 * x);
}

}  // namespace

Query disturbed(Query query, Kind kind, const Disturbance& by, Random& random) {
  if (by.turn == Turn::exact) turn_exactly(query, random);
  if (by.turn == Turn::rounded) turn_anyhow(query, random);
  if (by.permuted) permute(query, kind, random);
  if (by.exponent != 0) map_coordinates(query, [&](double x) { return std::ldexp(x, by.exponent); });
  if (by.ulps != 0) map_coordinates(query, [&](double x) { return off_by_ulps(x, by.ulps, random); });
  if (by.share != 0) {
    const double reach = by.share * extent(as_edge_edge(query));
    map_coordinates(query, [&](double x) { return x + reach * random.uniform(-1, 1); });
  }
  return query;
}

Disturbance suite_disturbance(std::size_t number, Random& random) {
  constexpr int ulps[] = {0, 1, 16, 1 << 20};
  constexpr Turn turns[] = {Turn::none, Turn::exact, Turn::rounded};
  constexpr int exponents[] = {0, 0, -20, 7};
  Disturbance by;
  by.ulps = ulps[number % 4];
  by.turn = turns[number / 4 % 3];
  by.exponent = exponents[random.integer(0, 3)];
  by.permuted = true;
  return by;
}

Random random_of(std::string_view family, Kind kind, std::size_t number, std::uint64_t seed) {
  std::uint64_t hash = digest_of(std::as_bytes(std::span(family)), kDigestOfNothing ^ seed);
  hash = digest_step(hash, static_cast<std::uint64_t>(kind));
  hash = digest_step(hash, number + 1);
  return Random(hash ^ (hash >> 29));
}

Query suite_query(const Family& family, Kind kind, std::size_t number, std::uint64_t seed) {
  Random random = random_of(family.name, kind, number, seed);
  const Query query = family.make(kind, random);
  const Disturbance by = suite_disturbance(number, random);
  return disturbed(query, kind, by, random);
}

Query random_query(const Family& family, Kind kind, double hardness, std::size_t number, std::uint64_t seed) {
  Random random = random_of(family.name, kind, number, seed + 1);
  Disturbance by;
  by.turn = Turn::rounded;
  by.share = hardness;
  const Query query = family.make(kind, random);
  return disturbed(query, kind, by, random);
}

}  // namespace cscd::scenes::hard
