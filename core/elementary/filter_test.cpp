#include "core/elementary/filter.h"

#include <gtest/gtest.h>

#include "core/elementary/exact.h"
#include "core/elementary/test_queries.h"

namespace cscd {
namespace {

using test::FourMovingPoints;
using test::query_of;
using test::QueryMaker;

// True of the filter is a proof: the referee is asked about every query that it drops.
template <class Query, class Make>
int expect_proofs(int queries, const Make& make_points) {
  int dropped = 0;
  for (int i = 0; i < queries; ++i) {
    const Query query = query_of<Query>(make_points(i));
    if (!never_coplanar(query)) continue;
    ++dropped;
    EXPECT_FALSE(exact::first_contact(query)) << i;
  }
  return dropped;
}

TEST(Filter, DropsOnlyWhatTheRefereeCallsApart) {
  QueryMaker make(1);
  EXPECT_GT(expect_proofs<MovingVertexFace>(5000, [&](int) { return make.any(); }), 100);
  EXPECT_GT(expect_proofs<MovingEdgeEdge>(5000, [&](int) { return make.any(); }), 100);
  EXPECT_GT(expect_proofs<MovingVertexFace>(10'000, [&](int) { return make.lattice(3); }), 50);
  EXPECT_GT(expect_proofs<MovingEdgeEdge>(10'000, [&](int) { return make.lattice(3); }), 50);
}

// Trap 7: touching in rounded coordinates, in the interior and at borders, at the ends of the interval, far
// from the origin, tiny and huge. The cubic at the time of contact is rounding noise.
TEST(Filter, KeepsWhatTouchesWithinRounding) {
  QueryMaker make(2);
  for (const double scale : {1.0, 1e-90, 1e-140, 1e95, 1e140}) {
    for (const double offset : {0.0, 1e3, 1e8}) {
      const auto place = [&](FourMovingPoints p) {
        const Vec3 by = offset * Vec3(1, -0.7, 0.3);
        for (MovingPoint& x : p) x = {scale * (x.start + by), scale * (x.end + by)};
        return p;
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

MovingPoint still(double x, double y, double z) {
  return {{x, y, z}, {x, y, z}};
}

// Trap 7: zero throughout excludes nothing; a volume that stays away from zero does.
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

}  // namespace
}  // namespace cscd
