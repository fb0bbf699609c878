#include "core/elementary/exact/static_contact.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <optional>
#include <random>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "core/elementary/exact/exact.h"
#include "core/elementary/exact/test_brute_oracle.h"
#include "core/elementary/question/test_queries.h"
#include "core/mesh/adjacency.h"

namespace cscd {

namespace {

using test::still;

// The oracle, asked about features at rest. It decides without any floating-point filter.
bool oracle_vertex_triangle(const Vec3& v, const Vec3& a, const Vec3& b, const Vec3& c) {
  return exact::first_contact(MovingVertexFace{still(v), {still(a), still(b), still(c)}}).has_value();
}
bool oracle_segments(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  return exact::first_contact(MovingEdgeEdge{{still(a), still(b)}, {still(c), still(d)}}).has_value();
}

// Decides a segment and a triangle in rational arithmetic. It finds the point at which the line meets the
// plane and tests that point against the triangle. If both are in one plane, it tests the ends and the
// edges.
using RationalPoint = std::array<mpq_class, 3>;
brute::PolyPoint constant(const RationalPoint& p) {
  brute::PolyPoint result;
  for (std::size_t k = 0; k < 3; ++k) result[k] = brute::trimmed({p[k]});
  return result;
}
RationalPoint rational(const Vec3& p) {
  return {mpq_class(p.x()), mpq_class(p.y()), mpq_class(p.z())};
}

bool brute_touch(const brute::Predicate& predicate, const RationalPoint& a, const RationalPoint& b,
                 const RationalPoint& c, const RationalPoint& d) {
  return brute::touches_at(predicate.events({constant(a), constant(b), constant(c), constant(d)}), predicate,
                           0);
}

bool brute_segment_triangle(const Vec3& p_, const Vec3& q_, const Vec3& a_, const Vec3& b_, const Vec3& c_) {
  using brute::operator-, brute::cross, brute::dot;
  const RationalPoint p = rational(p_), q = rational(q_), a = rational(a_), b = rational(b_),
                      c = rational(c_);
  const brute::PolyPoint origin = constant(a), n = cross(constant(b) - origin, constant(c) - origin);
  const mpq_class height_p = brute::value(dot(n, constant(p) - origin), 0);
  const mpq_class height_q = brute::value(dot(n, constant(q) - origin), 0);
  if (height_p * height_q > 0) return false;
  if (height_p != height_q) {
    const mpq_class s = height_p / (height_p - height_q);
    RationalPoint x;
    for (std::size_t k = 0; k < 3; ++k) x[k] = p[k] + s * (q[k] - p[k]);
    return brute_touch(brute::kVertexTriangle, x, a, b, c);
  }
  return brute_touch(brute::kVertexTriangle, p, a, b, c) || brute_touch(brute::kVertexTriangle, q, a, b, c) ||
         brute_touch(brute::kEdgeEdge, p, q, a, b) || brute_touch(brute::kEdgeEdge, p, q, b, c) ||
         brute_touch(brute::kEdgeEdge, p, q, c, a);
}

const Vec3 kA(0, 0, 0), kB(4, 0, 0), kC(0, 4, 0);
constexpr double kTiny = 0x1p-1074;

TEST(VertexTouchesTriangle, KnownCases) {
  for (const Vec3& v : {Vec3(1, 1, 0), Vec3(2, 2, 0), Vec3(1, 0, 0), Vec3(0, 3, 0), kA, kB, kC})
    EXPECT_TRUE(vertex_touches_triangle(v, kA, kB, kC)) << v.transpose();
  for (const Vec3& v : {Vec3(1, 1, kTiny), Vec3(1, 1, -1), Vec3(2, std::nextafter(2, 3), 0),
                        Vec3(-kTiny, 1, 0), Vec3(std::nextafter(4, 5), 0, 0), Vec3(3, 3, 0)})
    EXPECT_FALSE(vertex_touches_triangle(v, kA, kB, kC)) << v.transpose();
}

TEST(VertexTouchesTriangle, DegenerateTriangles) {
  const Vec3 middle(1, 1, 1), end(3, 3, 3);
  EXPECT_TRUE(vertex_touches_triangle(Vec3(2, 2, 2), kA, middle, end));
  EXPECT_FALSE(vertex_touches_triangle(Vec3(2, 2, 2), kA, middle, middle));
  EXPECT_FALSE(vertex_touches_triangle(Vec3(2, 2, 1), kA, middle, end));
  EXPECT_TRUE(vertex_touches_triangle(middle, middle, middle, middle));
  EXPECT_FALSE(vertex_touches_triangle(kA, middle, middle, middle));
}

TEST(SegmentsTouch, KnownCases) {
  EXPECT_TRUE(segments_touch(kA, kB, Vec3(1, -1, 0), Vec3(1, 1, 0)));
  EXPECT_TRUE(segments_touch(kA, kB, Vec3(1, 0, 0), Vec3(1, 1, 5)));
  EXPECT_TRUE(segments_touch(kA, kB, kB, Vec3(7, 7, 7)));
  EXPECT_TRUE(segments_touch(kA, kB, Vec3(2, 0, 0), Vec3(9, 0, 0)));
  EXPECT_TRUE(segments_touch(kA, kB, Vec3(2, 0, 0), Vec3(2, 0, 0)));
  EXPECT_FALSE(segments_touch(kA, kB, Vec3(1, -1, kTiny), Vec3(1, 1, kTiny)));
  EXPECT_FALSE(segments_touch(kA, kB, Vec3(std::nextafter(4, 5), 0, 0), Vec3(9, 0, 0)));
  EXPECT_FALSE(segments_touch(kA, kB, Vec3(0, kTiny, 0), Vec3(4, kTiny, 0)));
  EXPECT_FALSE(segments_touch(kA, kA, kB, kB));
  EXPECT_FALSE(segments_touch(kA, Vec3(4, 4, 0), Vec3(4, 3, 0), Vec3(3, 2, 0)));
}

TEST(SegmentTouchesTriangle, KnownCases) {
  const auto touches = [](const Vec3& p, const Vec3& q) {
    const bool answer = segment_touches_triangle(p, q, kA, kB, kC);
    EXPECT_EQ(segment_touches_triangle(q, p, kA, kB, kC), answer);
    EXPECT_EQ(segment_touches_triangle(p, q, kC, kB, kA), answer);
    EXPECT_EQ(segment_touches_triangle(p, q, kB, kC, kA), answer);
    return answer;
  };
  EXPECT_TRUE(touches({1, 1, 1}, {1, 1, -1}));      // through the interior
  EXPECT_TRUE(touches({2, 2, 1}, {2, 2, -1}));      // through an edge
  EXPECT_TRUE(touches({0, 0, 1}, {0, 0, -1}));      // through a corner
  EXPECT_TRUE(touches({1, 1, 0}, {1, 1, 5}));       // an end on the triangle
  EXPECT_TRUE(touches({1, 1, 0}, {1.5, 1, 0}));     // inside, in the plane
  EXPECT_TRUE(touches({-1, 1, 0}, {9, 1, 0}));      // right across, in the plane
  EXPECT_TRUE(touches({-1, 4, 0}, {1, 4, 0}));      // touches a corner, in the plane
  EXPECT_TRUE(touches({1, 1, 0}, {1, 1, 0}));       // a point
  EXPECT_FALSE(touches({1, 1, 1}, {1, 1, kTiny}));  // ends above
  EXPECT_FALSE(touches({3, 2, 1}, {3, 2, -1}));     // passes beside
  EXPECT_FALSE(touches({5, -1, 0}, {5, 9, 0}));     // beside, in the plane
  EXPECT_FALSE(touches({3, 3, 0}, {3, 3, 0}));
  EXPECT_FALSE(touches({-kTiny, 0, 1}, {-kTiny, 0, -1}));
}

TEST(SegmentTouchesTriangle, DegenerateTriangles) {
  const Vec3 end(4, 4, 0);
  EXPECT_TRUE(segment_touches_triangle({0, 4, 0}, {4, 0, 0}, kA, end, Vec3(1, 1, 0)));
  EXPECT_TRUE(segment_touches_triangle({1, 1, -1}, {1, 1, 1}, kA, end, end));
  EXPECT_FALSE(segment_touches_triangle({1, 2, -1}, {1, 2, 1}, kA, end, Vec3(1, 1, 0)));
  EXPECT_TRUE(segment_touches_triangle({0, 0, -1}, {0, 0, 1}, kA, kA, kA));
  EXPECT_FALSE(segment_touches_triangle({0, 0, 2}, {0, 0, 1}, kA, kA, kA));
}

TEST(StaticContact, ExtremeCoordinates) {
  for (const double s : {kTiny, 0x1p-1000, 0x1p-340, 0x1p340, 0x1p1020}) {
    EXPECT_TRUE(vertex_touches_triangle(s * Vec3(1, 1, 0), s * kA, s * kB, s * kC)) << s;
    EXPECT_FALSE(vertex_touches_triangle(s * Vec3(3, 3, 0), s * kA, s * kB, s * kC)) << s;
    EXPECT_FALSE(vertex_touches_triangle(s * Vec3(1, 1, 1), s * kA, s * kB, s * Vec3(0, 4, 3))) << s;
    EXPECT_TRUE(segments_touch(s * kA, s * kB, s * Vec3(1, -1, 1), s * Vec3(1, 1, -1))) << s;
    EXPECT_FALSE(segments_touch(s * kA, s * kB, s * Vec3(1, -1, 2), s * Vec3(1, 2, -1))) << s;
    EXPECT_TRUE(segment_touches_triangle(s * Vec3(1, 1, 3), s * Vec3(1, 1, -3), s * kA, s * kB, s * kC)) << s;
    EXPECT_FALSE(segment_touches_triangle(s * Vec3(3, 2, 3), s * Vec3(3, 2, -3), s * kA, s * kB, s * kC))
        << s;
  }
}

std::string describe(std::initializer_list<Vec3> points) {
  std::ostringstream text;
  text.precision(17);
  for (const Vec3& p : points) text << "(" << p.transpose() << ") ";
  return text.str();
}

TEST(StaticContact, AgreesWithRationalArithmeticOnSmallIntegers) {
  constexpr unsigned seed = 99;
  std::mt19937_64 random(seed);
  int touching[3] = {0, 0, 0};
  constexpr int cases = 6000;
  for (int i = 0; i < cases; ++i) {
    const int reach = 1 + i % 2;
    std::uniform_int_distribution<int> coordinate(-reach, reach);
    std::array<Vec3, 5> x;
    for (Vec3& p : x) p = Vec3(coordinate(random), coordinate(random), i % 3 == 0 ? 0 : coordinate(random));
    SCOPED_TRACE("seed " + std::to_string(seed) + " case " + std::to_string(i) + ": " +
                 describe({x[0], x[1], x[2], x[3], x[4]}));
    const RationalPoint a = rational(x[0]), b = rational(x[1]), c = rational(x[2]), d = rational(x[3]);
    const bool vertex = vertex_touches_triangle(x[0], x[1], x[2], x[3]);
    const bool segments = segments_touch(x[0], x[1], x[2], x[3]);
    const bool segment = segment_touches_triangle(x[0], x[1], x[2], x[3], x[4]);
    ASSERT_EQ(vertex, brute_touch(brute::kVertexTriangle, a, b, c, d));
    ASSERT_EQ(segments, brute_touch(brute::kEdgeEdge, a, b, c, d));
    ASSERT_EQ(segment, brute_segment_triangle(x[0], x[1], x[2], x[3], x[4]));
    touching[0] += vertex;
    touching[1] += segments;
    touching[2] += segment;
  }
  for (const int count : touching) {
    EXPECT_GT(count, cases / 20);
    EXPECT_LT(count, cases * 19 / 20);
  }
}

// Rounding alone keeps these points out of contact, or in contact. The filters must leave them to the exact
// step.
TEST(StaticContact, IsNeverMisledByRounding) {
  constexpr unsigned seed = 4;
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(-1, 1), weight(0, 1);
  int touching[3] = {0, 0, 0};
  constexpr int cases = 20000;
  for (int i = 0; i < cases; ++i) {
    // The coordinates have few bits. They are on or off a coarse grid, near the origin or far from it.
    const double grid = std::ldexp(1, -3 - i % 48), offset = i % 3 == 0 ? 0 : std::ldexp(1, i % 7);
    const auto point = [&] {
      Vec3 p(unit(random), unit(random), unit(random));
      for (double& c : p) c = std::round(c / grid) * grid + offset;
      return p;
    };
    const Vec3 a = point(), b = point(), c = point();
    const double s = weight(random), t = (1 - s) * weight(random);
    const Vec3 on_triangle = a + s * (b - a) + t * (c - a), on_ab = a + s * (b - a);
    const Vec3 far = point(), opposite = on_ab + (on_ab - far), through = on_triangle + (on_triangle - far);
    SCOPED_TRACE("seed " + std::to_string(seed) + " case " + std::to_string(i) + ": " +
                 describe({a, b, c, on_triangle, on_ab, far}));
    for (const Vec3& v : {on_triangle, on_ab}) {
      const bool vertex = vertex_touches_triangle(v, a, b, c);
      ASSERT_EQ(vertex, oracle_vertex_triangle(v, a, b, c));
      touching[0] += vertex;
    }
    for (const Vec3& end : {on_ab, opposite}) {
      const bool segments = segments_touch(a, b, far, end);
      ASSERT_EQ(segments, oracle_segments(a, b, far, end));
      touching[1] += segments;
    }
    if (i % 4 == 0)
      for (const Vec3& end : {on_triangle, on_ab, opposite, through}) {
        const bool segment = segment_touches_triangle(far, end, a, b, c);
        ASSERT_EQ(segment, brute_segment_triangle(far, end, a, b, c));
        touching[2] += segment;
      }
  }
  for (const int count : touching) EXPECT_GT(count, 100);
}

// Scaling each axis by its own power of two does not change contact, but it changes roundings and underflows.
TEST(StaticContact, KeepsItsAnswerWhenAxesAreScaledApart) {
  constexpr unsigned seed = 12;
  std::mt19937_64 random(seed);
  std::uniform_int_distribution<int> coordinate(-6, 6);
  const Vec3 scales[] = {
      {0x1p-538, 0x1p-538, 0x1p500}, {0x1p400, 0x1p-541, 0x1p-536}, {0x1p-1070, 0x1p900, 0x1p-30}};
  for (int i = 0; i < 10000; ++i) {
    std::array<Vec3, 5> x;
    for (Vec3& p : x) p = Vec3(coordinate(random), coordinate(random), coordinate(random));
    // Two thirds of the cases lie in a common plane.
    if (i % 3 != 0)
      for (Vec3& p : x) p.z() = i % 3 * p.x() - 3 * p.y();
    SCOPED_TRACE("seed " + std::to_string(seed) + " case " + std::to_string(i) + ": " +
                 describe({x[0], x[1], x[2], x[3], x[4]}));
    const bool vertex = vertex_touches_triangle(x[0], x[1], x[2], x[3]);
    const bool segments = segments_touch(x[0], x[1], x[2], x[3]);
    const bool segment = segment_touches_triangle(x[0], x[1], x[2], x[3], x[4]);
    for (const Vec3& scale : scales) {
      const auto y = [&](std::size_t k) { return Vec3(x[k].cwiseProduct(scale)); };
      ASSERT_EQ(vertex_touches_triangle(y(0), y(1), y(2), y(3)), vertex);
      ASSERT_EQ(segments_touch(y(0), y(1), y(2), y(3)), segments);
      ASSERT_EQ(segment_touches_triangle(y(0), y(1), y(2), y(3), y(4)), segment);
    }
  }
}

// The points are multiples of one vector by factors so different that coordinate differences are rounded.
// These are exact contacts that every projection may show a little off.
TEST(StaticContact, FindsContactWhereDifferencesAreRounded) {
  constexpr unsigned seed = 13;
  std::mt19937_64 random(seed);
  std::uniform_int_distribution<int> coordinate(-(1 << 20), 1 << 20), exponent(30, 60);
  for (int i = 0; i < 10000; ++i) {
    Vec3 d(coordinate(random), coordinate(random), coordinate(random));
    if (i % 2 == 0) d[i / 2 % 3] = 0;
    const Vec3 near = std::ldexp(1, -exponent(random)) * d, far = std::ldexp(1, exponent(random)) * d;
    const Vec3 aside(coordinate(random), coordinate(random), i % 2 == 0 ? 0 : coordinate(random));
    SCOPED_TRACE("seed " + std::to_string(seed) + " case " + std::to_string(i) + ": " +
                 describe({near, d, far, aside}));
    ASSERT_TRUE(vertex_touches_triangle(d, near, far, aside));
    ASSERT_TRUE(vertex_touches_triangle(d, aside, near, far));
    ASSERT_TRUE(segments_touch(near, far, d, aside));
    ASSERT_TRUE(segment_touches_triangle(d, aside, near, far, aside));
    ASSERT_TRUE(segment_touches_triangle(near, far, aside, d, aside));
  }
}

bool meet(const std::vector<Triangle>& triangles, const std::vector<Vec3>& positions) {
  const TriangleMesh mesh(triangles, positions.size());
  const bool meets = triangles_meet(mesh, positions, TriangleId{0}, TriangleId{1});
  EXPECT_EQ(triangles_meet(mesh, positions, TriangleId{1}, TriangleId{0}), meets);
  return meets;
}

// Two triangles with a common edge are folded onto each other. Their other edges cross, while neither holds
// the other's third corner. Mutation: edges that share a vertex are asked, and not those that share none.
TEST(TrianglesMeet, NeighboursThatAreFoldedShutMeet) {
  const VertexId v{0}, w{1}, p{2}, q{3};
  const std::vector<Triangle> triangles = {{v, w, p}, {w, v, q}};
  std::vector<Vec3> positions = {{0, 0, 0}, {4, 0, 0}, {5, 2, 0}, {-1, 2, 0}};
  EXPECT_TRUE(meet(triangles, positions));
  positions[3].z() = 0x1p-60;  // opened by next to nothing
  EXPECT_FALSE(meet(triangles, positions));
  positions[3] = {-1, -2, 0};
  EXPECT_FALSE(meet(triangles, positions));
}

// Two triangles with one common vertex: an edge of one runs over the side of the other that faces the vertex.
TEST(TrianglesMeet, AnEdgeFromACommonVertexCrossesTheSideThatFacesIt) {
  const VertexId v{0};
  const std::vector<Triangle> triangles = {{v, VertexId{1}, VertexId{2}}, {v, VertexId{3}, VertexId{4}}};
  std::vector<Vec3> positions = {{0, 0, 0}, {4, -1, 0}, {4, 1, 0}, {8, 0, 0}, {8, 0, 1}};
  EXPECT_TRUE(meet(triangles, positions));
  positions[3].z() = 0x1p-60;
  EXPECT_FALSE(meet(triangles, positions));
}

// Whether a point of `b` other than what both share lies on `a`, by the predicates alone, over all features.
bool reaches(const TriangleMesh& mesh, std::span<const Vec3> x, TriangleId a, TriangleId b) {
  const auto at = [&](VertexId v) { return x[static_cast<std::size_t>(v)]; };
  const Triangle& t = mesh.corners(a);
  bool touch = false;
  for (const VertexId v : mesh.corners(b))
    touch |= !contains(t, v) && vertex_touches_triangle(at(v), at(t[0]), at(t[1]), at(t[2]));
  for (const EdgeId e : mesh.edges_of(b)) {
    const Edge& edge = mesh.ends(e);
    if (!contains(t, edge[0]) && !contains(t, edge[1]))
      touch |= segment_touches_triangle(at(edge[0]), at(edge[1]), at(t[0]), at(t[1]), at(t[2]));
    for (const EdgeId f : mesh.edges_of(a)) {
      const Edge& other = mesh.ends(f);
      touch |=
          !share_vertex(edge, other) && segments_touch(at(edge[0]), at(edge[1]), at(other[0]), at(other[1]));
    }
  }
  return touch;
}

// Most triangles on a coarse grid are degenerate, coplanar or touch. Mutations: a vertex in the plane counts
// as beside it; sides that differ count as one.
TEST(TrianglesMeet, AsTheirFeaturesDoOnACoarseGrid) {
  std::mt19937 random(7);
  std::uniform_int_distribution<int> coordinate(0, 2);
  std::size_t meeting = 0, apart = 0;
  for (int round = 0; round < 60'000; ++round) {
    const int shared = round % 3;
    const VertexId v[] = {VertexId{0}, VertexId{1}, VertexId{2}, VertexId{3}, VertexId{4}, VertexId{5}};
    const std::vector<Triangle> triangles = {{v[0], v[1], v[2]},
                                             {v[shared > 1 ? 1 : 3], v[shared > 0 ? 0 : 4], v[5]}};
    std::vector<Vec3> positions(6);
    for (Vec3& p : positions)
      for (int k = 0; k < 3; ++k) p[k] = coordinate(random);
    const TriangleMesh mesh(triangles, positions.size());
    const bool expected = reaches(mesh, positions, TriangleId{0}, TriangleId{1}) ||
                          reaches(mesh, positions, TriangleId{1}, TriangleId{0});
    ASSERT_EQ(meet(triangles, positions), expected) << "round " << round;
    ++(expected ? meeting : apart);
  }
  EXPECT_GT(meeting, 10'000u);
  EXPECT_GT(apart, 10'000u);
}

// The segment in which a triangle cuts the plane of another, as places along the line where both planes meet;
// exact up to rounding for small integers. Nothing where it has no corners on both sides of that plane.
std::optional<std::array<double, 2>> cut(const std::array<Vec3, 3>& t, const std::array<Vec3, 3>& plane,
                                         const Vec3& along) {
  const Vec3 normal = (plane[1] - plane[0]).cross(plane[2] - plane[0]);
  std::array<double, 3> side;
  for (std::size_t k = 0; k < 3; ++k) side[k] = normal.dot(t[k] - plane[0]);
  if (*std::ranges::min_element(side) >= 0 || *std::ranges::max_element(side) <= 0) return std::nullopt;
  double low = 1e300, high = -1e300;
  const auto add = [&](double at) { low = std::min(low, at), high = std::max(high, at); };
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t next = (k + 1) % 3;
    if (side[k] == 0) add(along.dot(t[k]));
    if (side[k] * side[next] < 0) add(along.dot(t[k] + side[k] / (side[k] - side[next]) * (t[next] - t[k])));
  }
  return std::array{low, high};
}

// Mutations: signs that are not strict; a corner on a plane counted as beyond it; a plane that is not turned.
TEST(TrianglesCross, IfTheyShareASegmentThatIsNoPoint) {
  std::mt19937 random(7);
  std::uniform_int_distribution<int> small(0, 3);
  const auto point = [&] { return Vec3(small(random), small(random), small(random)); };
  std::size_t crossing = 0, touching = 0;
  for (int i = 0; i < 100'000; ++i) {
    const bool neighbours = i % 3 == 0;
    std::vector<Vec3> x{point(), point(), point(), point(), point(), point()};
    if (neighbours) x[3] = x[0];
    const Triangle first{VertexId{0}, VertexId{1}, VertexId{2}},
        second{VertexId{neighbours ? 0 : 3}, VertexId{4}, VertexId{5}};
    const TriangleMesh mesh(std::vector{first, second}, 6);
    const std::array<Vec3, 3> a{x[0], x[1], x[2]}, b{x[3], x[4], x[5]};
    const Vec3 along = (a[1] - a[0]).cross(a[2] - a[0]).cross((b[1] - b[0]).cross(b[2] - b[0]));
    const auto one = cut(a, b, along), other = cut(b, a, along);
    const bool expected =
        one && other && std::max((*one)[0], (*other)[0]) + 1e-9 < std::min((*one)[1], (*other)[1]);
    ASSERT_EQ(triangles_cross(mesh, x, TriangleId{0}, TriangleId{1}), expected) << i;
    ASSERT_EQ(triangles_cross(mesh, x, TriangleId{1}, TriangleId{0}), expected) << i;
    const bool meet = triangles_meet(mesh, x, TriangleId{0}, TriangleId{1});
    ASSERT_TRUE(meet || !expected) << i;
    crossing += expected;
    touching += meet && !expected;
  }
  EXPECT_GT(crossing, 5000u);
  EXPECT_GT(touching, 5000u);
}

// In planes of several slopes. Mutations: corners are not compared with the plane; triangles that share an
// edge lie on each other; facings are not compared.
TEST(LieOnEachOther, IfTheySharePartOfTheirInsides) {
  struct Case {
    const char* what;
    std::array<int, 6> other;  // x and y of its corners
    int expected;
  };
  constexpr Case kCases[] = {
      {"the same", {0, 0, 4, 0, 0, 4}, 1},
      {"named from another corner", {0, 4, 0, 0, 4, 0}, 1},
      {"turned over", {0, 0, 0, 4, 4, 0}, -1},
      {"within it", {1, 1, 2, 1, 1, 2}, 1},
      {"about it", {-4, -4, 9, -4, -4, 9}, 1},
      {"each has corners outside of the other", {1, -1, 3, -1, 1, 2}, 1},
      {"on the other side of an edge", {4, 0, 4, 4, 0, 4}, 0},
      {"shares an edge from outside", {-4, 0, 0, 0, 0, 4}, 0},
      {"shares a corner", {0, 0, -4, 0, 0, -4}, 0},
      {"apart", {5, 0, 9, 0, 5, 4}, 0},
      {"has no area", {0, 0, 2, 2, 4, 4}, 0},
  };
  const TriangleMesh mesh(
      {Triangle{VertexId{0}, VertexId{1}, VertexId{2}}, Triangle{VertexId{3}, VertexId{4}, VertexId{5}}}, 6);
  for (const auto& [slope_x, slope_y] : {std::pair(0, 0), std::pair(1, -2), std::pair(1'000'000, 3)})
    for (const int axis : {0, 1, 2})
      for (const Case& one : kCases)
        for (const double height : {0.0, 0x1p-30}) {
          std::vector<Vec3> at;
          const auto put = [&](int x, int y, double above) {
            Vec3 p;
            p[axis] = x, p[(axis + 1) % 3] = y, p[(axis + 2) % 3] = slope_x * x + slope_y * y + above;
            at.push_back(p);
          };
          put(0, 0, 0), put(4, 0, 0), put(0, 4, 0);
          for (std::size_t i = 0; i < 6; i += 2) put(one.other[i], one.other[i + 1], height);
          const int expected = height > 0 ? 0 : one.expected;
          EXPECT_EQ(lie_on_each_other(mesh, at, TriangleId{0}, TriangleId{1}), expected) << one.what;
          EXPECT_EQ(lie_on_each_other(mesh, at, TriangleId{1}, TriangleId{0}), expected) << one.what;
        }
}

}  // namespace

}  // namespace cscd
