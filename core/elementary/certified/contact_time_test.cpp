#include "core/elementary/certified/contact_time.h"

#include <gmpxx.h>
#include <gtest/gtest.h>

#include "core/elementary/exact/exact.h"
#include "core/elementary/question/test_queries.h"

namespace cscd {
namespace {

using test::FourMovingPoints;
using test::query_of;
using test::QueryMaker;

TEST(Pairs, SumsAndProductsOfDoublesAreExact) {
  QueryMaker make(3);
  for (int i = 0; i < 20'000; ++i) {
    const double a = std::ldexp(make.uniform(), make.below(80) - 40),
                 b = std::ldexp(make.uniform(), make.below(80) - 40);
    const Pair sum = exact_sum(a, b), product = exact_product(a, b);
    ASSERT_EQ(mpq_class(sum.high) + mpq_class(sum.low), mpq_class(a) + mpq_class(b));
    ASSERT_EQ(mpq_class(product.high) + mpq_class(product.low), mpq_class(a) * mpq_class(b));
  }
}

TEST(Pairs, OperationsKeepTheirBounds) {
  QueryMaker make(4);
  const auto value = [](const Pair& p) { return mpq_class(mpq_class(p.high) + mpq_class(p.low)); };
  const auto any = [&] {
    return exact_sum(std::ldexp(make.uniform(), make.below(8)), std::ldexp(make.uniform(), -make.below(60)));
  };
  for (int i = 0; i < 20'000; ++i) {
    const Pair a = any(), b = i % 4 ? any() : Pair{-a.high, a.low / 3};
    const mpq_class x = value(a), y = value(b), unit(0x1p-103);
    ASSERT_LE(abs(mpq_class(value(a + b) - (x + y))), mpq_class(unit * (abs(x) + abs(y))));
    ASSERT_LE(abs(mpq_class(value(a - b) - (x - y))), mpq_class(unit * (abs(x) + abs(y))));
    ASSERT_LE(abs(mpq_class(value(a * b) - x * y)), mpq_class(unit * abs(mpq_class(x * y))));
  }
}

struct Count {
  int proved = 0, timed = 0;

  template <class Query>
  void add(const FourMovingPoints& points) {
    const Query query = query_of<Query>(points);
    const Triple v = triple(triple_points(query));
    const BernsteinCubic f = triple_product(v.p, v.q, v.r);
    if (!std::isfinite(f.error)) return;
    const DoublesResult found = decide_in_doubles<Query>(v, f);
    if (found.kind != DoublesResult::contact) return;
    ++proved;
    const CertainTime<double> certain =
        time_in_pairs(triple_points(query), v.sizes(), Cubic(f, 1), found.low, found.high);
    if (!certain.known) return;
    ++timed;
    const auto truth = exact::first_contact(query);
    ASSERT_TRUE(truth);
    ASSERT_EQ(certain.time, truth->lo);
  }
};

// The pairs find the largest double not above the root for nearly all contacts.
TEST(TimeInPairs, IsTheOracles) {
  QueryMaker make(5);
  Count vf, ee;
  for (int i = 0; i < 4000; ++i) {
    const double t = make.uniform(0, 1), u = make.uniform(0.01, 0.49), v = make.uniform(0.01, 0.49);
    vf.add<MovingVertexFace>(test::vertex_meets_face(make, t, u, v));
    ee.add<MovingEdgeEdge>(test::edge_meets_edge(make, t, 2 * u, 2 * v));
  }
  for (const Count* count : {&vf, &ee}) {
    EXPECT_GT(count->proved, 3900);
    EXPECT_GT(count->timed, count->proved - count->proved / 50);
  }
}

// The slope of a cubic is off by up to six times the error of its coefficients, so a cubic whose error allows
// a level slope has no certain time. Mutation: the error counts once.
TEST(TimeInPairs, RuleErrorBoundIsNotKnownWhereTheSlopeMayBeLevel) {
  QueryMaker make(7);
  int known = 0;
  for (int i = 0; i < 500; ++i) {
    const auto query =
        query_of<MovingVertexFace>(test::vertex_meets_face(make, make.uniform(0.1, 0.9), 0.25, 0.5));
    const Triple v = triple(triple_points(query));
    const BernsteinCubic f = triple_product(v.p, v.q, v.r);
    const DoublesResult found = decide_in_doubles<MovingVertexFace>(v, f);
    if (found.kind != DoublesResult::contact) continue;
    const auto is_known = [&](double error) {
      const Cubic cubic({{f.c[0], f.c[1], f.c[2], f.c[3]}, error}, 1);
      return time_in_pairs(triple_points(query), v.sizes(), cubic, found.low, found.high).known;
    };
    known += is_known(f.error);
    EXPECT_FALSE(is_known(std::abs(Cubic(f, 1).slope(found.low)) / 6));
  }
  EXPECT_GT(known, 400);
}

// The roots are doubles, or next to doubles. The pairs must give no answer or the right answer.
TEST(TimeInPairs, SaysNothingThatIsNotCertain) {
  QueryMaker make(6);
  Count vf, ee;
  for (int i = 0; i < 30'000; ++i) {
    const FourMovingPoints p = test::scaled(make.lattice(4), i % 3 ? 1 : 0.1);
    vf.add<MovingVertexFace>(p);
    ee.add<MovingEdgeEdge>(p);
  }
  for (const Count* count : {&vf, &ee}) {
    EXPECT_GT(count->proved, 500);
    EXPECT_LT(count->timed, count->proved);
  }
}

}  // namespace
}  // namespace cscd
