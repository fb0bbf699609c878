#include "core/elementary/question/filter.h"

#include <gtest/gtest.h>

#include "core/elementary/exact/exact.h"
#include "core/elementary/question/test_filter.h"
#include "core/elementary/question/test_queries.h"

namespace cscd {
namespace {

using test::FourMovingPoints;
using test::never_meet_in_plane;
using test::query_of;
using test::QueryMaker;
using test::still;

// The queries that each part of the filter drops.
struct Dropped {
  int by_coplanarity = 0, sideways = 0;
};
// Asks the oracle about every query that the filter drops: both parts of the filter have to be proofs.
template <class Query, class Make>
Dropped expect_proofs(int queries, const Make& make_points) {
  Dropped dropped;
  for (int i = 0; i < queries; ++i) {
    const Query query = query_of<Query>(make_points(i));
    const bool coplanar = !never_coplanar(query), sideways = never_meet_in_plane(query);
    if (coplanar && !sideways) continue;
    dropped.by_coplanarity += !coplanar;
    dropped.sideways += coplanar;
    EXPECT_FALSE(exact::first_contact(query)) << i;
  }
  return dropped;
}

// Mutation: test one end of the interval alone; leave out the extent of the features; take the second edge
// for the first.
TEST(Filter, DropsOnlyWhatTheOracleCallsApart) {
  QueryMaker make(1);
  const auto expect_many = [](const Dropped& dropped) {
    EXPECT_GT(dropped.by_coplanarity, 50);
    EXPECT_GT(dropped.sideways, 50);
  };
  expect_many(expect_proofs<MovingVertexFace>(5000, [&](int) { return make.any(); }));
  expect_many(expect_proofs<MovingEdgeEdge>(5000, [&](int) { return make.any(); }));
  expect_many(expect_proofs<MovingVertexFace>(10'000, [&](int) { return make.lattice(3); }));
  expect_many(expect_proofs<MovingEdgeEdge>(10'000, [&](int) { return make.lattice(3); }));
}

// Rule certain-sign. Features touch up to the rounding of their coordinates: in the interior and at
// borders, at the ends of the interval, far from the origin, tiny and huge. At the time of contact the
// cubic is rounding noise.
TEST(Filter, KeepsWhatTouchesWithinRounding) {
  QueryMaker make(2);
  for (const double scale : {1.0, 1e-90, 1e-140, 1e95, 1e140}) {
    for (const double offset : {0.0, 1e3, 1e8}) {
      const auto place = [&](const FourMovingPoints& p) {
        const Vec3 by = offset * Vec3(1, -0.7, 0.3);
        return test::scaled(test::moved(p, by, by), scale);
      };
      const auto params = [&](int i, double& t, double& u, double& v) {
        t = i % 3 == 0 ? 0 : i % 3 == 1 ? 1 : make.uniform(0, 1);
        u = i % 2 ? 0 : make.uniform(0, 0.5);
        v = i % 5 ? make.uniform(0, 0.5) : 1 - u;
      };
      expect_proofs<MovingVertexFace>(600, [&](int i) {
        double t, u, v;
        params(i, t, u, v);
        return place(test::vertex_meets_face(make, t, u, v));
      });
      expect_proofs<MovingEdgeEdge>(600, [&](int i) {
        double t, u, v;
        params(i, t, u, v);
        return place(test::edge_meets_edge(make, t, u, v));
      });
    }
  }
}

// Rule certain-sign. A volume that is zero throughout excludes nothing; a volume that stays away from zero
// excludes contact.
TEST(Filter, KnowsZeroFromApart) {
  const MovingPoint a = still(0, 0, 0), b = still(4, 0, 0), c = still(0, 4, 0);
  EXPECT_FALSE(never_coplanar(MovingVertexFace{still(1, 1, 0), {a, b, c}}));
  EXPECT_FALSE(never_coplanar(MovingVertexFace{{{9, 9, 0}, {7, 7, 0}}, {a, b, c}}));
  EXPECT_FALSE(never_coplanar(MovingVertexFace{still(1, 1, 1), {a, b, b}}));
  EXPECT_FALSE(never_coplanar(MovingVertexFace{{{1, 1, 1}, {1, 1, 0}}, {a, b, c}}));
  EXPECT_FALSE(never_coplanar(MovingVertexFace{{{1, 1, 1}, {1, 1, -1}}, {a, b, c}}));
  EXPECT_TRUE(never_coplanar(MovingVertexFace{still(1, 1, 1), {a, b, c}}));
  EXPECT_TRUE(never_coplanar(MovingVertexFace{{{1, 1, -1}, {3, 1, -2}}, {a, b, c}}));
  EXPECT_FALSE(never_coplanar(MovingEdgeEdge{{a, b}, {still(1, 0, 1), still(3, 0, 1)}}));  // parallel
  EXPECT_FALSE(never_coplanar(MovingEdgeEdge{{a, b}, {c, c}}));
  EXPECT_FALSE(never_coplanar(MovingEdgeEdge{{a, b}, {still(1, -1, 0), still(1, 1, 0)}}));
  EXPECT_TRUE(never_coplanar(MovingEdgeEdge{{a, b}, {still(1, -1, 1), still(1, 1, 1)}}));
}

// Rule certain-sign. A vertex comes to lie exactly on an edge at an end of the interval, or an edge starts
// exactly on another edge. The coordinates have few bits, so the touch is exact while the directions are
// rounded. Some scales are tiny enough for products to underflow. Mutation: leave out the bound on
// rounding; use the bound at any size.
TEST(Filter, KeepsWhatTouchesABorderExactly) {
  QueryMaker make(4);
  const auto few_bits = [&] { return std::ldexp(std::round(make.uniform(-1, 1) * 0x1p16), -14); };
  const auto point = [&] {
    const double x = few_bits(), y = few_bits(), z = few_bits();
    return Vec3(x, y, z);
  };
  for (const double scale : {1.0, 0x1p-262, 0x1p-263, 0x1p-264, 0x1p250})
    for (int i = 0; i < 20'000; ++i) {
      const Vec3 a = point(), b = point(), c = point(), d = point(), on = a + (1 + i % 3) / 4.0 * (b - a);
      const auto at = [&](const Vec3& p) { return MovingPoint{scale * p, scale * p}; };
      // A point that comes to the edge or leaves the edge, in the plane of the edge and c.
      const auto comes = [&](const Vec3& p) {
        const MovingPoint x{scale * p, scale * (p + p - c)};
        return i % 2 ? x : MovingPoint{x.end, x.start};
      };
      EXPECT_FALSE(never_meet_in_plane(MovingVertexFace{comes(on), {at(a), at(b), at(c)}}))
          << scale << ' ' << i;
      EXPECT_FALSE(never_meet_in_plane(MovingEdgeEdge{{at(a), at(b)}, {at(on), at(d)}})) << scale << ' ' << i;
    }
}

// The features are in one plane throughout, beside each other or just touching.
TEST(Filter, KnowsWhatStaysApartInOnePlane) {
  const MovingPoint a = still(0, 0, 0), b = still(4, 0, 0), c = still(0, 4, 0);
  for (const MovingPoint& beside : {still(3, 3, 0), still(-1, 1, 0), still(1, -1, 0)})
    EXPECT_TRUE(never_meet_in_plane(MovingVertexFace{beside, {a, b, c}}));
  for (const MovingPoint& on : {still(2, 2, 0), still(0, 1, 0), still(1, 0, 0), still(1, 1, 0), a, c})
    EXPECT_FALSE(never_meet_in_plane(MovingVertexFace{on, {a, b, c}}));
  EXPECT_FALSE(never_meet_in_plane(MovingVertexFace{{{-1, 1, 0}, {9, 1, 0}}, {a, b, c}}));  // passes through
  EXPECT_TRUE(never_meet_in_plane(MovingVertexFace{{{-1, 1, 1}, {-2, 1, -1}}, {a, b, c}}));
  EXPECT_TRUE(never_meet_in_plane(MovingEdgeEdge{{a, b}, {still(1, 1, 0), still(2, 3, 0)}}));
  EXPECT_FALSE(never_meet_in_plane(MovingEdgeEdge{{a, b}, {still(1, 0, 0), still(2, 3, 0)}}));
  EXPECT_FALSE(never_meet_in_plane(MovingEdgeEdge{{a, b}, {still(1, -1, 0), still(2, 3, 0)}}));
  EXPECT_FALSE(never_meet_in_plane(MovingEdgeEdge{{a, b}, {b, still(5, 1, 0)}}));
  EXPECT_FALSE(never_meet_in_plane(MovingVertexFace{still(1, 1, 1), {a, b, b}}));  // no plane
}

}  // namespace
}  // namespace cscd
