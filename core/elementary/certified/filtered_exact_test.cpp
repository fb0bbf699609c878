#include "core/elementary/certified/filtered_exact.h"

#include <bit>
#include <cmath>
#include <cstdlib>
#include <gtest/gtest.h>
#include <map>

#include "core/elementary/certified/doubles_stage.h"
#include "core/elementary/certified/exact_lanes.h"
#include "core/elementary/exact/exact.h"
#include "core/elementary/exact/test_brute_oracle.h"
#include "core/elementary/question/test_queries.h"

namespace cscd {
namespace {

using test::FourMovingPoints;
using test::query_of;
using test::QueryMaker;
using test::text;

Answer ask(const MovingVertexFace& q) {
  return filtered_exact_vertex_face(q);
}
Answer ask(const MovingEdgeEdge& q) {
  return filtered_exact_edge_edge(q);
}

bool same(const Answer& a, const Answer& b) {
  return a.verdict == b.verdict && (a.verdict == Verdict::apart || a.time == b.time);
}

// A family of queries. `add` compares the answer with the oracle's and counts the stage that gave the
// answer.
struct Family {
  int queries = 0, contacts = 0;
  std::map<ExactStage, int> stages;

  template <class Query>
  void add(const FourMovingPoints& points) {
    const Query query = query_of<Query>(points);
    const auto truth = exact::first_contact(query);
    const Answer answer = ask(query);
    ++queries;
    contacts += truth.has_value();
    ++stages[filtered_exact_stage(query)];
    ASSERT_EQ(answer.verdict, truth ? Verdict::contact : Verdict::apart) << text(points);
    if (truth) {
      ASSERT_EQ(answer.time, truth->lo) << text(points);
    }
  }
  void expect_both_answers() const {
    EXPECT_GT(contacts, queries / 50);
    EXPECT_LT(contacts, queries - queries / 50);
  }
};

// Queries that are asked together have the same answers as one by one.
template <class Query>
void expect_same_of_all(const std::vector<FourMovingPoints>& points) {
  std::vector<Query> queries;
  for (const FourMovingPoints& p : points) queries.push_back(query_of<Query>(p));
  std::vector<Answer> answers(queries.size());
  filtered_exact(queries, answers);
  for (std::size_t i = 0; i < queries.size(); ++i)
    ASSERT_TRUE(same(answers[i], ask(queries[i]))) << text(points[i]);
}

class FilteredExact : public testing::Test {
 protected:
  // Adds `count` queries of both kinds, with the points that make_points(i) gives.
  template <class MakePoints>
  void compare(int count, MakePoints&& make_points) {
    std::vector<FourMovingPoints> all;
    for (int i = 0; i < count && !HasFatalFailure(); ++i) {
      const FourMovingPoints points = make_points(i);
      vf_.add<MovingVertexFace>(points);
      ee_.add<MovingEdgeEdge>(points);
      all.push_back(points);
    }
    expect_same_of_all<MovingVertexFace>(all);
    expect_same_of_all<MovingEdgeEdge>(all);
  }
  void expect_both_answers() const {
    vf_.expect_both_answers();
    ee_.expect_both_answers();
  }
  QueryMaker make_{11};
  Family vf_, ee_;
};

TEST_F(FilteredExact, AgreesWithTheOracleOnQueriesOfNoParticularKind) {
  compare(10'000, [&](int) { return make_.any(); });
  expect_both_answers();
  // None of these queries needs exact arithmetic.
  for (const Family* family : {&vf_, &ee_})
    EXPECT_EQ(family->stages.at(ExactStage::filter) + family->stages.at(ExactStage::doubles), 10'000);
}

TEST_F(FilteredExact, AgreesWithTheOracleOnLattices) {
  for (const int n : {1, 2, 3, 4, 9}) compare(2000, [&](int) { return make_.lattice(n); });
  expect_both_answers();
  for (const Family* family : {&vf_, &ee_}) {
    EXPECT_GT(family->stages.at(ExactStage::integers), 1000);
    EXPECT_FALSE(family->stages.contains(ExactStage::oracle));
  }
}

// The coordinates are thirds and tenths of a lattice, some of them far from the origin, so their last
// places hold rounded bits.
TEST_F(FilteredExact, AgreesWithTheOracleOnRoundedLattices) {
  compare(8000, [&](int i) {
    const Vec3 shift = i % 3 == 0 ? Vec3(1e6, -3e5, 0.1) : Vec3::Zero();
    return test::moved(test::scaled(make_.lattice(1 + i % 4), i % 2 ? 0.1 : 1.0 / 3), shift, shift);
  });
  expect_both_answers();
}

// The features touch exactly on a lattice. Then one coordinate is moved by one ulp or a few.
TEST_F(FilteredExact, AgreesWithTheOracleAnUlpFromTouching) {
  const auto move = [&](FourMovingPoints& p) {
    MovingPoint& x = p[static_cast<std::size_t>(make_.below(4))];
    double& c = (make_.below(2) ? x.start : x.end)[make_.below(3)];
    const double away = make_.below(2) ? 1e9 : -1e9;
    for (int ulps = 1 << make_.below(4); ulps > 0; --ulps) c = std::nextafter(c, away);
  };
  // Moves the points away from 0, so that an ulp of a coordinate is not tiny.
  const auto apart_from_zero = [](const FourMovingPoints& p) {
    return test::moved(p, {17, 33, 65}, {17, 33, 65});
  };
  int tried = 0;
  while (vf_.queries < 4000 && tried++ < 100'000 && !HasFatalFailure()) {
    FourMovingPoints p = apart_from_zero(make_.lattice(3));
    if (!exact::first_contact(query_of<MovingVertexFace>(p))) continue;
    move(p);
    vf_.add<MovingVertexFace>(p);
  }
  while (ee_.queries < 4000 && tried++ < 200'000 && !HasFatalFailure()) {
    FourMovingPoints p = apart_from_zero(make_.lattice(3));
    if (!exact::first_contact(query_of<MovingEdgeEdge>(p))) continue;
    move(p);
    ee_.add<MovingEdgeEdge>(p);
  }
  EXPECT_EQ(vf_.queries, 4000);
  EXPECT_EQ(ee_.queries, 4000);
  expect_both_answers();
}

// Coordinates of a lattice are moved by single doubles, which takes zeros to the smallest doubles. The bits
// of such coordinates lie a thousand places apart.
TEST_F(FilteredExact, AgreesWithTheOracleTheSmallestOfDoublesFromALattice) {
  compare(1500, [&](int i) {
    FourMovingPoints p = make_.lattice(1 + i % 3);
    for (MovingPoint& x : p)
      for (Vec3* end : {&x.start, &x.end})
        for (int axis = 0; axis < 3; ++axis)
          for (int steps = make_.below(3); steps > 0; --steps)
            (*end)[axis] = std::nextafter((*end)[axis], i % 2 ? 1e9 : -1e9);
    return p;
  });
  expect_both_answers();
  for (Family* family : {&vf_, &ee_}) {
    EXPECT_GT(family->stages.at(ExactStage::integers), 300);
    EXPECT_LT(family->stages[ExactStage::oracle], family->queries / 100);
  }
}

// The features touch at borders, corners and ends, up to the rounding of the coordinates.
TEST_F(FilteredExact, AgreesWithTheOracleAtBorders) {
  const double places[] = {0, 0.5, 1, 1e-16, 1 - 1e-16, 1e-9, -1e-16};
  const auto place = [&] { return places[make_.below(7)]; };
  const double times[] = {0, 1, 0.5, 1.0 / 3, 1e-17, 1 - 1e-16};
  compare(4000, [&](int i) {
    const double t = times[make_.below(6)], u = place();
    return i % 2 ? test::vertex_meets_face(make_, t, u, make_.below(2) ? 1 - u : place() * (1 - u))
                 : test::edge_meets_edge(make_, t, u, place());
  });
  EXPECT_GT(vf_.contacts, 300);
  EXPECT_GT(ee_.contacts, 300);
}

// The cubics have double and triple roots, exactly or nearly.
TEST_F(FilteredExact, AgreesWithTheOracleOnFlatCubics) {
  compare(4000, [&](int i) {
    FourMovingPoints p = i % 2 ? make_.any() : make_.lattice(4);
    const double thin = std::ldexp(1.0, -20 - i % 60);
    if (i % 3 == 0)
      for (MovingPoint& x : p) x.start.z() *= thin, x.end.z() *= thin;
    else
      for (MovingPoint& x : p) x.end = -x.start + thin * make_.vector();
    return p;
  });
  expect_both_answers();
}

// The coordinates span the range of doubles. Neither underflow nor overflow may decide a query.
TEST_F(FilteredExact, AgreesWithTheOracleAtExtremesOfRange) {
  for (const double scale : {0x1p-1070, 1e-320, 1e-300, 0x1p-700, 1e-110, 1e110, 1e150, 1e300, 0x1p1019}) {
    vf_ = ee_ = {};
    compare(600, [&](int i) {
      return test::scaled(i % 3 ? make_.lattice(3) : test::vertex_meets_face(make_, 0.5, 0.25, 0.25), scale);
    });
    SCOPED_TRACE(scale);
    expect_both_answers();
    for (const Family* family : {&vf_, &ee_}) EXPECT_FALSE(family->stages.contains(ExactStage::oracle));
  }
}
TEST_F(FilteredExact, AgreesWithTheOracleOnMixedScales) {
  const double scales[] = {1e-300, 1e-150, 1e-20, 1, 1e20, 1e150, 1e300};
  compare(std::getenv("CSCD_FULL") ? 600 : 200, [&](int i) {
    FourMovingPoints p = make_.lattice(2);
    if (i % 2 == 0) {
      const Vec3 by(scales[make_.below(7)], scales[make_.below(7)], scales[make_.below(7)]);
      p = test::mapped(p, [&](const Vec3& x) -> Vec3 { return x.cwiseProduct(by); });
    } else {
      for (MovingPoint& x : p) x.start *= scales[make_.below(7)], x.end *= scales[make_.below(7)];
    }
    return p;
  });
  expect_both_answers();
}

// Some vectors are subnormal beside others that are not. The digits that such a vector loses between the
// ends of an interval must count as an error.
TEST_F(FilteredExact, AgreesWithTheOracleOnSubnormalVectors) {
  const FourMovingPoints lost = {
      MovingPoint{{0x1p-1074, 0x1p-1073, 0x1p-1073}, {0x1p-1072, 3 * 0x1p-1074, -3 * 0x1p-1074}},
      MovingPoint{Vec3::Zero(), Vec3::Zero()}, MovingPoint{{1e50, 1e50, 0}, {1e50, 1e50, 0}},
      MovingPoint{{-1e50, 1e50, 0}, {-1e50, 1e50, 0}}};
  vf_.add<MovingVertexFace>(lost);
  EXPECT_EQ(vf_.contacts, 1);
  for (const double large : {1e-20, 1e25, 1e50, 1e140})
    for (const double small : {0x1p-1074, 0x1p-1070, 1e-310, 1e-295})
      compare(100, [&](int i) {
        FourMovingPoints p = test::scaled(make_.lattice(4), large);
        const auto one = static_cast<std::size_t>(i % 4),
                   other = (one + 1 + static_cast<std::size_t>(i / 4 % 3)) % 4;
        p[one] = {small / large * p[one].start, small / large * p[one].end};
        p[other] = {Vec3::Zero(), Vec3::Zero()};
        return p;
      });
  expect_both_answers();
}

// The brute-force oracle shares no algorithm with filtered_exact or the oracle.
TEST_F(FilteredExact, AgreesWithBruteForceOnSmallIntegers) {
  const auto check = [](const FourMovingPoints& p, const Answer& answer, const brute::Predicate& predicate) {
    const auto expected = brute::first_contact(brute::moving(p), predicate);
    ASSERT_EQ(answer.verdict, expected ? Verdict::contact : Verdict::apart) << text(p);
    if (!expected) return;
    ASSERT_LE(mpq_class(answer.time), expected->upper) << text(p);
    ASSERT_GE(mpq_class(answer.time) + mpq_class(0x1p-50), expected->lower) << text(p);
  };
  for (int i = 0; i < 300 && !HasFatalFailure(); ++i) {
    const FourMovingPoints p = make_.lattice(1 + i % 3);
    check(p, ask(query_of<MovingVertexFace>(p)), brute::kVertexTriangle);
    check(p, ask(query_of<MovingEdgeEdge>(p)), brute::kEdgeEdge);
  }
}

TEST_F(FilteredExact, KeepsItsAnswerUnderSymmetries) {
  for (int i = 0; i < 4000; ++i) {
    const FourMovingPoints q = i % 4 == 0 ? make_.any() : make_.lattice(1 + i % 3);
    SCOPED_TRACE(text(q));
    const Answer vf = ask(query_of<MovingVertexFace>(q)), ee = ask(query_of<MovingEdgeEdge>(q));
    EXPECT_TRUE(same(vf, ask(MovingVertexFace{q[0], {q[2], q[3], q[1]}})));
    EXPECT_TRUE(same(vf, ask(MovingVertexFace{q[0], {q[3], q[1], q[2]}})));
    EXPECT_TRUE(same(vf, ask(MovingVertexFace{q[0], {q[2], q[1], q[3]}})));
    EXPECT_TRUE(same(ee, ask(MovingEdgeEdge{{q[2], q[3]}, {q[0], q[1]}})));
    EXPECT_TRUE(same(ee, ask(MovingEdgeEdge{{q[1], q[0]}, {q[2], q[3]}})));
    EXPECT_TRUE(same(ee, ask(MovingEdgeEdge{{q[0], q[1]}, {q[3], q[2]}})));

    const auto mapped = [&](const auto& map) { return test::mapped(q, map); };
    std::vector<FourMovingPoints> alike{
        mapped([](const Vec3& p) { return Vec3(0x1p-900 * p); }),
        mapped([](const Vec3& p) { return Vec3(0x1p900 * p); }),
        mapped([](const Vec3& p) { return Vec3(-p); }),
        mapped([](const Vec3& p) { return Vec3(p.y(), p.z(), p.x()); }),
        mapped([](const Vec3& p) { return Vec3(p.y(), p.x(), p.z()); }),
        mapped([](const Vec3& p) { return Vec3(0x1p-300 * p.x(), 0x1p200 * p.y(), p.z()); })};
    if (i % 4 != 0)  // the sum is exact for lattices
      alike.push_back(mapped([](const Vec3& p) { return Vec3(p + Vec3(1 << 20, -12345.5, 0x1p-20)); }));
    for (const FourMovingPoints& p : alike) {
      EXPECT_TRUE(same(vf, ask(query_of<MovingVertexFace>(p))));
      EXPECT_TRUE(same(ee, ask(query_of<MovingEdgeEdge>(p))));
    }

    const FourMovingPoints reversed = test::reversed(q);
    EXPECT_EQ(vf.verdict, ask(query_of<MovingVertexFace>(reversed)).verdict);
    EXPECT_EQ(ee.verdict, ask(query_of<MovingEdgeEdge>(reversed)).verdict);
    if (HasFailure()) return;
  }
}

// A vertex passes the tilted plane z = x by the smallest double, and the triangle is huge. This takes more
// bits than the integers hold.
TEST_F(FilteredExact, LeavesTheRestToTheOracle) {
  constexpr double tiny = 0x1p-1074, far = 0x1p900;
  const MovingPoint a = test::still(-far, -far, -far), b = test::still(far, -far, far),
                    c = test::still(0, far, 0);
  const MovingVertexFace crosses{{{tiny, 0, 2 * tiny}, {tiny, 0, 0}}, {a, b, c}},
      stays{{{tiny, 0, 3 * tiny}, {tiny, 0, 2 * tiny}}, {a, b, c}};
  for (const MovingVertexFace& query : {crosses, stays})
    EXPECT_EQ(filtered_exact_stage(query), ExactStage::oracle);
  EXPECT_EQ(ask(crosses).verdict, Verdict::contact);
  EXPECT_EQ(ask(crosses).time, 0.5);
  EXPECT_EQ(ask(stays).verdict, Verdict::apart);
}

// Lanes decide nearly all queries whose features meet inside, and most of the queries in general position.
// What they find is right. Mutation: parts of the interval are looked at in another order.
TEST_F(FilteredExact, DecidesMostQueriesSideBySide) {
  struct Shares {
    double once = 0, in_parts = 0;
  };
  // The shares of queries that the two looks of the lanes decide, in 1,000 blocks of one to eight queries.
  const auto decided = [](auto&& make_query) {
    using Query = decltype(make_query());
    Shares shares;
    double asked = 0;
    for (int i = 0; i < 1000; ++i) {
      std::vector<Query> queries;
      for (int l = 0; l <= i % 8; ++l) queries.push_back(make_query());
      std::vector<const Query*> pointers;
      for (const Query& query : queries) pointers.push_back(&query);
      asked += static_cast<double>(queries.size());
      const auto check = [&](const LaneFindings& found) {
        const CertainTime<Lane8> time = times_in_lanes<Query>(pointers, found.low, found.high);
        for (std::size_t l = 0; l < queries.size(); ++l) {
          const bool apart = found.apart >> l & 1, contact = found.contact >> l & 1;
          const Answer truth = apart || contact ? ask(queries[l]) : Answer{};
          EXPECT_FALSE(apart && contact);
          if (apart) {
            EXPECT_EQ(truth.verdict, Verdict::apart);
          }
          if (contact) {
            EXPECT_EQ(truth.verdict, Verdict::contact);
            EXPECT_TRUE(truth.time <= found.high[l] && truth.time >= found.low[l] - 0x1p-50);
            EXPECT_TRUE(!time.known[l] || time.time[l] == truth.time);
          }
        }
        return static_cast<double>(
            std::popcount((found.apart | found.contact) & ((1u << queries.size()) - 1)));
      };
      shares.once += check(find_once_in_lanes<Query>(pointers));
      shares.in_parts += check(find_in_parts_in_lanes<Query>(pointers));
    }
    return Shares{shares.once / asked, shares.in_parts / asked};
  };
  const auto expect = [&](auto&& make_query, double once, double in_parts) {
    const Shares shares = decided(make_query);
    EXPECT_GT(shares.once, once);
    EXPECT_GT(shares.in_parts, in_parts);
  };
  const auto inside = [&] { return make_.uniform(0.01, 0.49); };
  const auto time = [&] { return make_.uniform(0, 1); };
  expect([&] { return query_of<MovingVertexFace>(make_.any()); }, 0.4, 0.6);
  expect([&] { return query_of<MovingEdgeEdge>(make_.any()); }, 0.4, 0.6);
  expect(
      [&] { return query_of<MovingVertexFace>(test::vertex_meets_face(make_, time(), inside(), inside())); },
      0.9, 0.9);
  expect([&] { return query_of<MovingEdgeEdge>(test::edge_meets_edge(make_, time(), inside(), inside())); },
         0.9, 0.9);
}

// Mutation: without one of the error bounds, the stage in double precision makes wrong claims. The families
// above would show them.
struct NoComponentBound : ProvenBounds {
  static constexpr double component = 0;
};
struct NoCubicBound : ProvenBounds {
  static constexpr double cubic = 0;
};

// Three points at rest on one line and a fourth point aside. The distances on the line are so different that
// differences of points are rounded. The first point stays on the edge between the second and the third.
FourMovingPoints on_an_edge(QueryMaker& make) {
  const auto whole = [&] { return Vec3((make.vector() * 0x1p20).array().round()); };
  const Vec3 d = whole(), near = std::ldexp(1, -30 - make.below(30)) * d, far = std::ldexp(1, 30) * d;
  return {{{d, d}, {near, near}, {far, far}, {whole(), whole()}}};
}

// The number of queries about which the stage in double precision claims a wrong answer.
template <class Bounds, class Query>
int wrong_claims(QueryMaker& make) {
  int wrong = 0;
  for (int i = 0; i < 6000; ++i) {
    FourMovingPoints p = make.lattice(3);
    for (MovingPoint& x : p) x = {x.start / 3 + Vec3(7, 5, 3), x.end / 3 + Vec3(7, 5, 3)};
    if (i % 2) {
      p = on_an_edge(make);
      if (std::is_same_v<Query, MovingEdgeEdge>) p = {p[1], p[2], p[0], p[3]};
    }
    const Query query = query_of<Query>(p);
    const Triple v = triple(triple_points(query));
    const BernsteinCubic f = triple_product(v.p, v.q, v.r);
    if (!std::isfinite(f.error)) continue;
    const DoublesResult found = decide_in_doubles<Query, Bounds>(v, f);
    if (found.kind == DoublesResult::unclear) continue;
    const auto truth = exact::first_contact(query);
    wrong += truth.has_value() != (found.kind == DoublesResult::contact) ||
             (truth && !(found.low <= truth->hi && truth->lo <= found.high));
  }
  return wrong;
}
TEST_F(FilteredExact, EveryBoundIsNeeded) {
  EXPECT_EQ((wrong_claims<ProvenBounds, MovingVertexFace>(make_)), 0);
  EXPECT_EQ((wrong_claims<ProvenBounds, MovingEdgeEdge>(make_)), 0);
  EXPECT_GT((wrong_claims<NoComponentBound, MovingVertexFace>(make_)), 100);
  EXPECT_GT((wrong_claims<NoComponentBound, MovingEdgeEdge>(make_)), 100);
  EXPECT_GT((wrong_claims<NoCubicBound, MovingVertexFace>(make_)), 10);
  EXPECT_GT((wrong_claims<NoCubicBound, MovingEdgeEdge>(make_)), 10);
}

}  // namespace
}  // namespace cscd
