#include <array>

#include "core/elementary/exact/exact.h"
#include "scenes/hard/family.h"

namespace cscd::scenes::hard {
namespace {

// A point with integer coordinates in [-reach, reach].
Vec3 lattice_point(Random& random, int reach) {
  const auto coordinate = [&] { return static_cast<double>(random.integer(-reach, reach)); };
  const double x = coordinate(), y = coordinate(), z = coordinate();
  return {x, y, z};
}
// The same, but never zero.
Vec3 lattice_direction(Random& random, int reach) {
  for (;;)
    if (const Vec3 v = lattice_point(random, reach); v != Vec3::Zero()) return v;
}
MovingPoint at_rest(const Vec3& p) {
  return {p, p};
}
// A point that is at x at t = 1/2 and moves by `half_way` in half the interval.
MovingPoint through(const Vec3& x, const Vec3& half_way) {
  return {x - half_way, x + half_way};
}
MovingPoint moved(const MovingPoint& p, const Vec3& by_start, const Vec3& by_end) {
  return {p.start + by_start, p.end + by_end};
}
bool flip(Random& random) {
  return random.integer(0, 1) == 1;
}
template <class T>
T pick(Random& random, std::initializer_list<T> from) {
  return from.begin()[random.integer(0, static_cast<int>(from.size()) - 1)];
}

// Features in general position that touch at t = 1/2 or pass each other by one lattice step. Families of
// place and scale start from them. Coordinates are at most 64.
Query crossing(Kind kind, Random& random) {
  const Vec3 away = lattice_direction(random, 6);
  // The touching point, in quarters of the features' size. It is inside, on a border, or one quarter outside.
  const int u = random.integer(-1, 3), v = random.integer(0, 3 - std::max(u, 0));
  if (kind == Kind::vertex_face) {
    const Vec3 a = lattice_point(random, 8), ab = lattice_direction(random, 6),
               ac = lattice_direction(random, 6);
    const auto drift = [&] { return lattice_point(random, 1); };
    return {{through(a + u * ab + v * ac, away), through(a, drift()), through(a + 4 * ab, drift()),
             through(a + 4 * ac, drift())},
            {}};
  }
  const Vec3 x = lattice_point(random, 8), d = lattice_direction(random, 6), e = lattice_direction(random, 6);
  const Vec3 drift = lattice_point(random, 1);
  return {{through(x - u * d, drift), through(x + (4 - u) * d, drift), through(x - v * e, away),
           through(x + (4 - v) * e, away)},
          {}};
}

Query make_coplanar_sliding(Kind, Random& random) {
  const Vec3 o = lattice_point(random, 8), e1 = lattice_direction(random, 3),
             e2 = lattice_direction(random, 3);
  const Vec3 drift = flip(random) ? lattice_point(random, 4) : Vec3::Zero();
  const auto in_plane = [&] {
    const int i = random.integer(-8, 8), j = random.integer(-8, 8);
    return Vec3(o + i * e1 + j * e2);
  };
  Query query;
  for (MovingPoint& p : query.points) {
    const Vec3 start = in_plane();
    p = {start, in_plane() + drift};
  }
  return query;
}

Query make_parallel(Kind kind, Random& random) {
  const Vec3 d = lattice_direction(random, 3), a = lattice_point(random, 8);
  const int length = random.integer(1, 6), from = random.integer(-8, 8), other = random.integer(-6, 6);
  // The motion of the second feature relative to the line of the first: across the line, along the line, or
  // none.
  const Vec3 way = pick<Vec3>(random, {lattice_direction(random, 4), 2 * d, Vec3::Zero()});
  if (kind == Kind::vertex_face) {
    const Vec3 c = a + lattice_direction(random, 6);
    return {{through(a + from * d, way), at_rest(a), at_rest(a + length * d), at_rest(c)}, {}};
  }
  const Vec3 turn = flip(random) ? lattice_point(random, 2) : Vec3::Zero();
  return {{at_rest(a), at_rest(a + length * d), through(a + from * d, way),
           through(a + (from + other) * d, way + turn)},
          {}};
}

Query make_through_border(Kind kind, Random& random) {
  const Vec3 way = lattice_direction(random, 6), drift = lattice_point(random, 2);
  const Vec3 a = lattice_point(random, 8), ab = lattice_direction(random, 4),
             ac = lattice_direction(random, 4);
  const int s = pick(random, {-1, 0, 1, 2, 3, 4, 5});  // quarters along the border; -1 and 5 miss
  if (kind == Kind::vertex_face) {
    const int side = random.integer(0, 2);
    const Vec3 target = side == 0   ? Vec3(a + s * ab)
                        : side == 1 ? Vec3(a + s * ac)
                                    : Vec3(a + s * ab + (4 - s) * ac);
    return {{through(target, way), through(a, drift), through(a + 4 * ab, drift), through(a + 4 * ac, drift)},
            {}};
  }
  const Vec3 target = a + s * ab, second = lattice_direction(random, 6);
  const int end = random.integer(0, 1);
  return {{through(a, drift), through(a + 4 * ab, drift), through(target - 4 * end * second, way),
           through(target + 4 * (1 - end) * second, way)},
          {}};
}

Query make_grazing(Kind kind, Random& random) {
  // The height of one feature over the other is z0 - 2 r s (x0 + 2 p s) / 8, with s = t - 1/2.
  const double ulp = 0x1p-52;
  const double p = random.integer(1, 6), r = pick(random, {-3, -1, 1, 2, 5});
  const double z0 = pick(random, {0.0, 0.0, ulp, -ulp, 0x1p-30, -0x1p-30}),
               x0 = pick(random, {0.0, 0.0, ulp, -ulp, 0x1p-26});
  const double y = random.integer(-1, 8), at = random.integer(0, 3);
  const MovingPoint tilting{{8 - at, 0, -r}, {8 - at, 0, r}};
  if (kind == Kind::vertex_face) {
    const double back = r * at / (8 - at);  // the plane turns about the line x = 0
    const bool border = flip(random) || at == 0;
    const MovingPoint a = border ? at_rest({0, 0, 0}) : MovingPoint{{-at, 0, back}, {-at, 0, -back}};
    const MovingPoint c = border ? at_rest({0, 8, 0}) : MovingPoint{{-at, 8, back}, {-at, 8, -back}};
    return {
        {MovingPoint{{x0 - p, y, z0}, {x0 + p, y, z0}}, a, MovingPoint{{8 - at, 0, -r}, {8 - at, 0, r}}, c},
        {}};
  }
  const double half = random.integer(0, 4);
  return {{at_rest({0, 0, 0}), tilting, MovingPoint{{x0 - p, -half, z0}, {x0 + p, -half, z0}},
           MovingPoint{{x0 - p, 4, z0}, {x0 + p, 4, z0}}},
          {}};
}

Query make_interval_ends(Kind kind, Random& random) {
  const Query query = crossing(kind, random);
  const bool at_start = flip(random);
  Query cut;
  for (std::size_t k = 0; k < 4; ++k) {
    const MovingPoint& p = query.points[k];
    const Vec3 middle = p.start + (p.end - p.start) / 2;
    cut.points[k] = at_start ? MovingPoint{middle, p.end} : MovingPoint{p.start, middle};
  }
  return cut;
}

Query make_needles(Kind kind, Random& random) {
  const double length = 0x1p26, x = random.integer(1, (1 << 26) - 1);
  const auto height = [&] {
    const int middle = random.integer(0, 1), half = random.integer(1, 3);
    return through(Vec3(0, 0, middle), Vec3(0, 0, half));
  };
  const auto at = [&](double px, double py) {
    const MovingPoint z = height();
    return moved(z, {px, py, 0}, {px, py, 0});
  };
  if (kind == Kind::vertex_face) {
    const bool sliver = flip(random);  // the third corner is between the others, else beside the first
    const double y = random.integer(-1, 2);
    return {{at(sliver ? length / 2 : x, y), at_rest({0, 0, 0}), at_rest({length, 0, 0}),
             at_rest({sliver ? length / 2 : 0, 1, 0})},
            {}};
  }
  const double y = random.integer(-2, 1);
  const MovingPoint z = height();
  return {{at_rest({0, 0, 0}), at_rest({length, 0, 0}), moved(z, {x - length, y, 0}, {x - length, y, 0}),
           moved(z, {x, y + 1, 0}, {x, y + 1, 0})},
          {}};
}

Query make_collapsed(Kind kind, Random& random) {
  const Vec3 a = lattice_point(random, 6), d = lattice_direction(random, 3),
             way = lattice_direction(random, 5);
  const int s = random.integer(-1, 5), b = random.integer(0, 4), c = random.integer(0, 4);
  // If true, the features are collapsed for one instant only: the corners spread as time goes away from 1/2.
  const bool instant = flip(random);
  const auto spread = [&](const Vec3& p) {
    return through(p, instant ? lattice_point(random, 3) : Vec3(Vec3::Zero()));
  };
  if (kind == Kind::vertex_face) {
    const MovingPoint p = spread(a), q = spread(a + b * d), r = spread(a + c * d);
    return {{through(a + s * d, way), p, q, r}, {}};
  }
  const MovingPoint p = spread(a + s * d), q = spread(a + s * d);
  return {{at_rest(a), at_rest(a + 4 * d), moved(p, -way, way), moved(q, -way, way)}, {}};
}

Query make_at_rest(Kind kind, Random& random) {
  Query query = crossing(kind, random);
  const bool in_plane = random.integer(0, 3) != 0;
  for (MovingPoint& p : query.points) p = at_rest(in_plane ? Vec3(p.start + (p.end - p.start) / 2) : p.start);
  return query;
}

Query make_common_motion(Kind kind, Random& random) {
  Query query = crossing(kind, random);
  const Vec3 common = 0x1p24 * lattice_direction(random, 4);
  for (MovingPoint& p : query.points) p.end += common;
  return query;
}

Query make_far_away(Kind kind, Random& random) {
  Query query = crossing(kind, random);
  const double distance = pick(random, {0x1p10, 0x1p20, 0x1p30, 0x1p40, 0x1p44});
  const Vec3 offset = distance * lattice_direction(random, 4);
  for (MovingPoint& p : query.points) p = moved(p, offset, offset);
  return query;
}

Query make_extreme_scale(Kind kind, Random& random) {
  Query query = crossing(kind, random);
  const bool mixed = flip(random);
  const double all = pick(random, {0x1p-1074, 0x1p-1060, 0x1p-1000, 0x1p-500, 0x1p498, 0x1p990});
  const double x = pick(random, {0x1p-1070, 0x1p-300, 1.0}), z = pick(random, {1.0, 0x1p300, 0x1p990});
  const Vec3 scale = mixed ? Vec3(x, 1, z) : Vec3(all, all, all);
  for (MovingPoint& p : query.points) p = {scale.cwiseProduct(p.start), scale.cwiseProduct(p.end)};
  return query;
}

Query make_cancelling(Kind, Random& random) {
  const Vec3 e1 = lattice_direction(random, 1 << 10), e2 = lattice_direction(random, 1 << 10);
  Query query;
  for (MovingPoint& p : query.points) {
    const auto in_plane = [&] {
      const int i = random.integer(-1 << 9, 1 << 9), j = random.integer(-1 << 9, 1 << 9);
      return Vec3(i * e1 + j * e2);
    };
    const Vec3 step = lattice_point(random, 1), start = in_plane();
    const Vec3 end = flip(random) ? in_plane() : start;
    p = {start - step, end + step};
  }
  return query;
}

Query make_folded_neighbours(Kind kind, Random& random) {
  const Vec3 p = lattice_point(random, 6), pq = lattice_direction(random, 4),
             pr = lattice_direction(random, 4);
  const Vec3 normal = pq.cross(pr);
  const int u = random.integer(-1, 4), v = random.integer(0, 4);
  const Vec3 shut = p + u * pq + v * pr;  // the place of the other apex when the triangles are shut
  const double beyond = pick(random, {0, 0, 1, -1});
  const MovingPoint apex{shut + normal, shut - beyond * normal};
  const Vec3 q = p + 4 * pq, r = p + 4 * pr;
  if (kind == Kind::vertex_face) return {{apex, at_rest(p), at_rest(q), at_rest(r)}, {}};
  return {{at_rest(p), at_rest(r), at_rest(q), apex}, {}};
}

Query make_symmetric(Kind, Random& random) {
  const int half = random.integer(1, 4), motion = random.integer(0, 3);
  const auto corner = [&] {
    const double x = flip(random) ? half : -half, y = flip(random) ? half : -half,
                 z = flip(random) ? half : -half;
    return Vec3(x, y, z);
  };
  const bool hollow = flip(random);  // points are middles of the cube's edges, else corners
  Query query;
  for (MovingPoint& p : query.points) {
    Vec3 start = corner();
    if (hollow) start[random.integer(0, 2)] = 0;
    const Vec3 ends[] = {-start,
                         {start.y(), start.z(), start.x()},
                         {-start.x(), start.y(), start.z()},
                         {-start.y(), start.x(), start.z()}};
    p = {start, ends[motion]};
  }
  return query;
}

Query make_small_integers(Kind, Random& random) {
  Query query;
  for (MovingPoint& p : query.points) {
    const Vec3 start = lattice_point(random, 2);
    p = {start, lattice_point(random, 2)};
  }
  return query;
}

}  // namespace

std::span<const Family> families() {
  static const std::array all = {
      Family{
          "coplanar_sliding",
          "All four points stay in one plane, which may move. The coplanarity cubic is zero throughout, so "
          "tests that look for its roots find none, or all times. Contact is a question of two dimensions.",
          make_coplanar_sliding},
      Family{"parallel",
             "Edges that are parallel, or on one line, when they meet: the normal of the two is zero where "
             "it is needed. For a vertex and a face: a path along the line of one of its edges.",
             make_parallel},
      Family{"through_border",
             "A vertex goes exactly through an edge or a corner of the face, an end of an edge through the "
             "other edge or its end. One rounding to the wrong side loses it, here and for the neighbour "
             "that shares the border.",
             make_through_border},
      Family{"grazing",
             "The features come to one plane, touch, and part on the side they came from: a double root, or "
             "two roots as little as one ulp apart, or none by as little. Roots of the rounded cubic are "
             "wrong by the square root of the rounding.",
             make_grazing},
      Family{"interval_ends",
             "Contact at t = 0 exactly, on the way apart, or at t = 1 exactly. A root of 1 that is rounded "
             "to 1 + 2^-52 is lost here and found in contact in the next interval, at its start.",
             make_interval_ends},
      Family{"needles",
             "Triangles and pairs of edges with an aspect of a hundred million: the normal is small beside "
             "the edges that it is made of, and barycentric coordinates divide by its square.",
             make_needles},
      Family{"collapsed",
             "Triangles without area, edges without length, from the start, throughout, or for one instant: "
             "nothing has a normal, and a division by its length is one by zero.",
             make_collapsed},
      Family{"at_rest",
             "Nothing moves. In contact all the time or never; every coefficient of the cubic is the same "
             "number, often zero.",
             make_at_rest},
      Family{
          "common_motion",
          "Everything moves together by a million times its size while it crosses by its size: the swept "
          "bounds are all of space, and the digits of the relative motion are the last of the absolute one.",
          make_common_motion},
      Family{"far_away",
             "Far from the origin: coordinates leave few digits, or a single one, to the features "
             "themselves. Bounds on rounding that do not grow with the coordinates miss contacts here.",
             make_far_away},
      Family{"extreme_scale",
             "From the smallest subnormal numbers to 1e300, and both at once along different axes: products "
             "of coordinates underflow to zero, which looks like touching, or overflow to infinity and NaN, "
             "which compare as nothing.",
             make_extreme_scale},
      Family{"cancelling",
             "Within a lattice step of one plane throughout, with coordinates of a million: the cubic is a "
             "sum of products of 1e18 that cancel to a number of a few digits, or to none.",
             make_cancelling},
      Family{
          "folded_neighbours",
          "Two triangles with a common edge that fold shut to exact coplanarity, or through each other. What "
          "is tested are the features that they do not share; they start and stay next to each other.",
          make_folded_neighbours},
      Family{"symmetric",
             "Corners of a cube that turn inside out, mirror or rotate: several pairs of features touch at "
             "one instant, at one point, and which is first must not depend on who is asked first.",
             make_symmetric},
      Family{"small_integers",
             "Coordinates of 0, 1 and 2, at random: every degeneracy comes up by chance, several at once.",
             make_small_integers},
  };
  return all;
}

bool in_contact(const Query& query, Kind kind) {
  return kind == Kind::vertex_face ? exact::first_contact(as_vertex_face(query)).has_value()
                                   : exact::first_contact(as_edge_edge(query)).has_value();
}

}  // namespace cscd::scenes::hard
