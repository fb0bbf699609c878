#include "core/elementary/certified/close_doubles.h"

#include <cmath>
#include <functional>
#include <gmpxx.h>
#include <gtest/gtest.h>
#include <map>

#include "core/elementary/certified/approximate.h"
#include "core/elementary/certified/filtered_exact.h"
#include "core/elementary/exact/closeness.h"
#include "core/elementary/question/test_queries.h"

namespace cscd {
namespace {

using test::FourMovingPoints;
using test::query_of;
using test::QueryMaker;

// Sums and products of random numbers, some nearly cancelling, beside the same in rational numbers.
template <class Value>
void expect_errors_bound_roundings(const std::function<Value(double)>& from) {
  const auto exact = [](const Value& v) {
    if constexpr (std::is_same_v<Value, double>)
      return mpq_class(v);
    else
      return mpq_class(mpq_class(v.high) + mpq_class(v.low));
  };
  QueryMaker make(3);
  int rounded = 0;
  for (int i = 0; i < 2000; ++i) {
    Approximate<Value> number{from(1), 0};
    mpq_class truth = 1;
    for (int k = 0; k < 12; ++k) {
      const double x = make.below(4) == 0 ? -truth.get_d() : make.uniform();
      const Approximate<Value> other{from(x), 0};
      switch (make.below(3)) {
        case 0:
          number = number + other, truth += mpq_class(x);
          break;
        case 1:
          number = number - other, truth -= mpq_class(x);
          break;
        default:
          number = number * (other + number), truth *= mpq_class(x) + truth;
      }
      ASSERT_LE(abs(exact(number.value) - truth), mpq_class(number.error)) << i;
      if (number.sign() != 0) {
        ASSERT_EQ(number.sign(), sgn(truth)) << i;
      }
      rounded += exact(number.value) != truth;
    }
  }
  EXPECT_GT(rounded, 5000);
}

TEST(Approximate, ErrorsBoundRoundings) {
  expect_errors_bound_roundings<double>([](double x) { return x; });
  expect_errors_bound_roundings<Pair>([](double x) { return Pair{x, 0}; });
}

TEST(Approximate, SlopesAreDerivatives) {
  // (2 + 3 t) (1 - t) - t at t = 2, whose derivative is 1 - 6 t - 1.
  const auto line = [](double at, double slope) {
    return WithSlope<Approximate<double>>{{at, 0}, {slope, 0}};
  };
  const auto f = line(8, 3) * line(-1, -1) - line(2, 1);
  EXPECT_EQ(f.value.value, -10);
  EXPECT_EQ(f.slope.value, -12);
}

// Compares answers with the oracle's, and counts the stages that gave them.
struct CloseFamily {
  int apart = 0, close = 0;
  std::map<ExactStage, int> stages;

  template <class Query>
  void add(const FourMovingPoints& points, double r) {
    const Query query = query_of<Query>(points);
    const auto truth = exact::first_closeness(query, r);
    Answer answer;
    filtered_exact_close(std::span(&query, 1), std::span(&r, 1), std::span(&answer, 1));
    ++(truth ? close : apart);
    ++stages[filtered_exact_close_stage(query, r)];
    ASSERT_EQ(answer.verdict, truth ? Verdict::contact : Verdict::apart) << test::text(points, "r = ", r);
    if (truth) {
      ASSERT_EQ(answer.time, truth->lo) << test::text(points, "r = ", r);
    }
  }
  void add_both(const FourMovingPoints& points, double r) {
    add<MovingVertexFace>(points, r);
    if (!testing::Test::HasFatalFailure()) add<MovingEdgeEdge>(points, r);
  }
  int by_oracle() { return stages[ExactStage::oracle]; }
  int all() const { return apart + close; }
};

TEST(FilteredExactClose, AnswersAsTheOracleInGeneralPosition) {
  QueryMaker make(1);
  CloseFamily slow, fast, far;
  for (int i = 0; i < 1500; ++i) {
    FourMovingPoints points = make.any();
    const double r = std::exp(make.uniform(-5, -1));
    ASSERT_NO_FATAL_FAILURE(fast.add_both(points, r));
    ASSERT_NO_FATAL_FAILURE(far.add_both(test::moved(points, {1e3, 2e3, -1e3}, {1e5, 1e2, 0}), r));
    for (MovingPoint& p : points) p.end = p.start + 0.1 * make.vector();
    ASSERT_NO_FATAL_FAILURE(slow.add_both(points, r));
  }
  for (CloseFamily* family : {&slow, &fast, &far}) {
    EXPECT_GT(family->apart, 150);
    EXPECT_GT(family->close, 150);
    // Doubles settle nearly all.
    EXPECT_LT(family->by_oracle(), 0.002 * family->all());
  }
}

// Coordinates on a lattice, r such that many distances are exactly r.
TEST(FilteredExactClose, AnswersAsTheOracleOnALattice) {
  QueryMaker make(2);
  CloseFamily family;
  for (int i = 0; i < 4000; ++i)
    ASSERT_NO_FATAL_FAILURE(family.add_both(make.lattice(1 + i % 3), 0.5 * (1 + make.below(6))));
  EXPECT_GT(family.apart, 200);
  EXPECT_GT(family.close, 1000);
  // Integers settle what doubles leave open, but for some that graze the distance.
  EXPECT_GT(family.stages[ExactStage::integers], 500);
  EXPECT_LT(family.by_oracle(), 0.01 * family.all());
}

// Edges that stay parallel, and vertices that come straight down on an edge of a face's border: several pairs
// of features are nearest together. Coordinates have 20 bits, so that sums are exact.
TEST(FilteredExactClose, DoublesSettleFeaturesThatStayParallel) {
  QueryMaker make(6);
  const auto bits = [&] {
    const auto one = [&] { return (make.below(1 << 21) - (1 << 20)) * 0x1p-20; };
    const double x = one(), y = one(), z = one();
    return Vec3(x, y, z);
  };
  const auto path = [](const Vec3& p, const Vec3& way) { return MovingPoint{p, p + way}; };
  CloseFamily parallel, border;
  for (int i = 0; i < 400; ++i) {
    const Vec3 u = bits(), a = bits(), from = a + bits(), way = 1.5 * (a - from), drift = 0.125 * bits();
    const double r = make.uniform(0.01, 0.2);
    ASSERT_NO_FATAL_FAILURE(parallel.add<MovingEdgeEdge>(
        {path(from, way), path(from + u, way), path(a, drift), path(a + 0.5 * u, drift)}, r));
    ASSERT_NO_FATAL_FAILURE(
        border.add<MovingVertexFace>({path(from + 0.25 * u, way), path(a, drift), path(a + u, drift),
                                      path(a + (from - a).cross(u), drift)},
                                     r));
  }
  EXPECT_GT(parallel.close, 150);
  EXPECT_LT(parallel.by_oracle(), 0.05 * parallel.all());
  EXPECT_GT(border.close, 150);
  EXPECT_LT(border.by_oracle(), 0.05 * border.all());
}

// Features that graze each other's distance, come close at t = 0 or t = 1, or stay at the distance.
TEST(FilteredExactClose, AnswersAsTheOracleWhereDistancesAreNearlyR) {
  QueryMaker make(4);
  CloseFamily family;
  for (int i = 0; i < 2000; ++i) {
    const double r = std::exp(make.uniform(-7, -1)), hair = make.below(3) - 1;
    const double t = std::array{0.0, 0.5, 1.0}[static_cast<std::size_t>(i % 3)];
    FourMovingPoints points =
        i % 2 == 0 ? test::vertex_meets_face(make, t, 0.3, 0.3) : test::edge_meets_edge(make, t, 0.4, 0.3);
    const Vec3 n =
        i % 2 == 0
            ? (points[2].at(t) - points[1].at(t)).cross(points[3].at(t) - points[1].at(t)).normalized()
            : (points[1].at(t) - points[0].at(t)).cross(points[3].at(t) - points[2].at(t)).normalized();
    // Take the features apart by r, up to a hair, at the time at which they would meet.
    const Vec3 apart = r * (1 + hair * 0x1p-50) * n;
    points[0].start += apart, points[0].end += apart;
    if (i % 2 == 1) points[1].start += apart, points[1].end += apart;
    if (i % 5 == 0)
      for (MovingPoint& p : points) p.end = p.start;
    ASSERT_NO_FATAL_FAILURE(i % 2 == 0 ? family.add<MovingVertexFace>(points, r)
                                       : family.add<MovingEdgeEdge>(points, r));
  }
  EXPECT_GT(family.apart, 100);
  EXPECT_GT(family.close, 1000);
}

TEST(FilteredExactClose, AnswersAsTheOracleAtAnySize) {
  QueryMaker make(5);
  for (const double size : {0x1p-1060, 0x1p-500, 0x1p-120, 0x1p-60, 0x1p60, 0x1p200, 0x1p1000}) {
    CloseFamily family;
    for (int i = 0; i < 40; ++i) {
      const FourMovingPoints points = test::scaled(i % 2 == 0 ? make.any() : make.lattice(2), size);
      ASSERT_NO_FATAL_FAILURE(family.add_both(points, size * make.uniform(0.1, 1)));
    }
    EXPECT_GT(family.close, 20);
  }
  CloseFamily tiny, huge;
  for (int i = 0; i < 100; ++i) {
    const FourMovingPoints points = i % 2 == 0 ? test::vertex_meets_face(make, 0.5, 0.3, 0.3) : make.any();
    ASSERT_NO_FATAL_FAILURE(tiny.add_both(points, i < 4 ? 0x1p-1074 : std::exp(make.uniform(-60, -10))));
    ASSERT_NO_FATAL_FAILURE(huge.add_both(points, std::exp(make.uniform(2, 80))));
  }
  EXPECT_GT(tiny.close, 40);
  EXPECT_EQ(huge.close, huge.all());
  EXPECT_EQ(huge.by_oracle(), 0);
}

}  // namespace
}  // namespace cscd
