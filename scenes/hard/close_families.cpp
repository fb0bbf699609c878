#include <array>
#include <cmath>
#include <utility>

#include "core/elementary/exact/closeness.h"
#include "scenes/hard/disturbance.h"
#include "scenes/hard/family.h"

namespace cscd::scenes::hard {
namespace {

// An orthogonal frame of lattice vectors, of which `along` has an integer length.
struct Frame {
  Vec3 along, across, aside;
  double length;
};

Frame lattice_frame(Random& random) {
  static const std::array<Frame, 4> frames = {Frame{{0, 0, 1}, {1, 0, 0}, {0, 1, 0}, 1},
                                              {{0, 3, 4}, {1, 0, 0}, {0, 4, -3}, 5},
                                              {{1, 2, 2}, {2, 1, -2}, {2, -2, 1}, 3},
                                              {{2, 3, 6}, {3, -6, 2}, {6, 2, -3}, 7}};
  Frame frame = frames[static_cast<std::size_t>(random.integer(0, 3))];
  if (random.integer(0, 1) == 1) frame.along = -frame.along;
  if (random.integer(0, 1) == 1) std::swap(frame.across, frame.aside);
  return frame;
}

using Pose = std::array<Vec3, 4>;

// Features whose nearest points are those of one case, r along `along`: a vertex and the inside, an edge or a
// corner of a face; the insides of two edges, an end and an inside, or two ends. At times the nearest points
// lie on the border of two cases.
Pose pose_of_case(Kind kind, int number, const Frame& f, double r, Random& random) {
  const Vec3 a = random.whole(-8, 8), gap = r / f.length * f.along;
  const double u = random.integer(0, 4), v = random.integer(0, 4 - static_cast<int>(u));
  // Away from the other feature, or beside the nearest point on the border.
  const Vec3 back = random.integer(0, 3) * f.along;
  if (kind == Kind::vertex_face) {
    if (number == 0) return {a + u * f.across + v * f.aside + gap, a, a + 4 * f.across, a + 4 * f.aside};
    if (number == 1) return {a + u * f.across + gap, a, a + 4 * f.across, a - back + 3 * f.aside};
    return {a + gap, a, a - back + 3 * f.across, a - back - f.along + 2 * f.aside};
  }
  const Vec3 b = a + gap;
  if (number == 0) return {a - u * f.across, a + (4 - u) * f.across, b - v * f.aside, b + (4 - v) * f.aside};
  if (number == 1)
    return {a - u * f.across, a + (4 - u) * f.across, b, b + back + 2 * f.aside + v * f.across};
  return {a, a - back - 3 * f.across, b, b + back + 2 * f.aside + v * f.across};
}

// The first feature moves by 2 `half_way` and is in the pose at t = 1/2.
Query passing(Kind kind, const Pose& pose, const Vec3& half_way) {
  const std::size_t first = kind == Kind::vertex_face ? 1 : 2;
  Query query;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3 by = i < first ? half_way : Vec3(Vec3::Zero());
    query.points[i] = {pose[i] - by, pose[i] + by};
  }
  return query;
}
// Which way the first feature lies from the second along `along`.
double side(Kind kind) {
  return kind == Kind::vertex_face ? 1 : -1;
}
// r, or the neighbours of r, so that the features come exactly as near, or just not, or a little nearer.
double about(double r, Random& random) {
  const int hair = random.integer(-1, 1);
  return hair == 0 ? r : std::nextafter(r, hair * HUGE_VAL);
}

CloseQuery make_nearest_features(Kind kind, Random& random) {
  const Frame f = lattice_frame(random);
  const double r = f.length * random.integer(1, 4);
  const Pose pose = pose_of_case(kind, random.integer(0, 2), f, r, random);
  const Vec3 sideways = random.integer(-1, 1) * f.aside;
  const Vec3 drift = random.integer(-1, 1) * f.across + sideways;
  // Half of the features stop where they are exactly r apart.
  Query query = passing(kind, pose, drift - side(kind) * f.along);
  if (random.integer(0, 1) == 1)
    for (std::size_t i = 0; i < 4; ++i) query.points[i].end = pose[i];
  return {query, about(r, random)};
}

CloseQuery make_grazing_at_r(Kind kind, Random& random) {
  const Frame f = lattice_frame(random);
  const double r = f.length * random.integer(1, 4);
  const Pose pose = pose_of_case(kind, random.integer(0, 2), f, r, random);
  const Vec3 sideways = random.integer(-3, 3) * f.aside;
  const Vec3 way = random.integer(1, 3) * f.across + sideways;
  return {passing(kind, pose, way), about(r, random)};
}

CloseQuery make_parallel_at_r(Kind kind, Random& random) {
  const Frame f = lattice_frame(random);
  const double r = f.length * random.integer(1, 4);
  const Vec3 a = random.whole(-8, 8), b = a + r / f.length * f.along;
  const double from = random.integer(-6, 6), to = from + random.integer(1, 6);
  // Across the gap, along the edges, or with a turn out of the parallel.
  const int way = random.integer(0, 2);
  const Vec3 half_way = way == 0 ? Vec3(side(kind) * -f.along) : Vec3(random.integer(-8, 8) * f.across);
  if (kind == Kind::vertex_face)
    return {
        passing(kind, {b + from * f.across, a, a + 4 * f.across, a + (way == 2 ? 2 * f.across : 3 * f.aside)},
                half_way),
        about(r, random)};
  Query query = passing(kind, {a, a + 4 * f.across, b + from * f.across, b + to * f.across}, half_way);
  if (way == 2) query.points[0].end += f.along;
  return {query, about(r, random)};
}

CloseQuery make_ends_at_r(Kind kind, Random& random) {
  const Frame f = lattice_frame(random);
  const double r = f.length * random.integer(1, 4);
  const Pose pose = pose_of_case(kind, random.integer(0, 2), f, r, random);
  const Vec3 sideways = random.integer(-2, 2) * f.across;
  const Vec3 way = side(kind) * random.integer(1, 4) * f.along + sideways;
  const bool at_start = random.integer(0, 1) == 1;
  Query query = passing(kind, pose, way);
  for (std::size_t i = 0; i < 4; ++i) {
    MovingPoint& p = query.points[i];
    p = at_start ? MovingPoint{pose[i], p.end} : MovingPoint{p.end, pose[i]};
  }
  return {query, about(r, random)};
}

CloseQuery make_tiny_r(Kind kind, Random& random) {
  constexpr std::array exponents = {-20, -40, -52, -60, -100, -300};
  const Frame f = lattice_frame(random);
  const double r = std::ldexp(f.length, exponents[static_cast<std::size_t>(random.integer(0, 5))]);
  // The features touch at t = 1/2, or stay a hair apart there; or they stop within r or just not.
  const double apart = random.integer(0, 2) * r;
  const Pose pose = pose_of_case(kind, random.integer(0, 2), f, apart, random);
  Query query = passing(kind, pose, (random.integer(0, 1) - side(kind)) * f.along + f.across);
  if (random.integer(0, 1) == 1)
    for (std::size_t i = 0; i < 4; ++i) query.points[i].end = pose[i];
  return {query, r};
}

CloseQuery make_huge_r(Kind kind, Random& random) {
  const Frame f = lattice_frame(random);
  const double r = std::ldexp(f.length, random.integer(10, 44));
  const Pose pose = pose_of_case(kind, random.integer(0, 2), f, r, random);
  const Vec3 sideways = random.integer(-1, 1) * f.across;
  const Vec3 way = random.integer(-1, 1) * f.along + sideways;
  return {passing(kind, pose, way), about(r, random)};
}

}  // namespace

std::span<const CloseFamily> close_families() {
  static constexpr std::array all = {
      CloseFamily{"nearest_features",
                  "The nearest points lie inside a face, on an edge or in a corner, inside two edges, inside "
                  "one or in "
                  "ends, or on the border of two of these. Half of the features stop exactly r apart.",
                  make_nearest_features},
      CloseFamily{
          "grazing_at_r",
          "The features pass each other and are r apart for one instant, or for a while: a double root, or a "
          "polynomial that is zero throughout.",
          make_grazing_at_r},
      CloseFamily{"parallel_at_r",
                  "Parallel edges, a vertex that moves along a face or an edge, faces without area: the "
                  "nearest points "
                  "are many, and the normal of two edges is zero.",
                  make_parallel_at_r},
      CloseFamily{"ends_at_r", "The features are r apart at t = 0 exactly, or at t = 1 exactly.",
                  make_ends_at_r},
      CloseFamily{"tiny_r",
                  "r is a millionth of the features and less, down to 2^-300: its square is lost beside "
                  "other squares, "
                  "or underflows when it is squared once more.",
                  make_tiny_r},
      CloseFamily{
          "huge_r",
          "r is up to 2^44 times the size of the features, so that the distance hardly tells where on the "
          "features the nearest points lie.",
          make_huge_r},
  };
  return all;
}

CloseQuery close_suite_query(const CloseFamily& family, Kind kind, std::size_t number, std::uint64_t seed) {
  Random random = random_of(family.name, kind, number, seed);
  const CloseQuery made = family.make(kind, random);
  Disturbance by = suite_disturbance(number, random);
  if (by.turn == Turn::exact) by.turn = Turn::none;  // may change lengths, and frames are turned already
  return {disturbed(made.query, kind, by, random), std::ldexp(made.r, by.exponent)};
}

bool is_close(const CloseQuery& q, Kind kind) {
  return kind == Kind::vertex_face ? exact::first_closeness(as_vertex_face(q.query), q.r).has_value()
                                   : exact::first_closeness(as_edge_edge(q.query), q.r).has_value();
}

}  // namespace cscd::scenes::hard
