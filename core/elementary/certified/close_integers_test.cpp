#include "core/elementary/certified/close_integers.h"

#include <cmath>
#include <gtest/gtest.h>
#include <map>
#include <type_traits>

#include "core/elementary/certified/close_doubles.h"
#include "core/elementary/certified/filtered_exact.h"
#include "core/elementary/exact/closeness.h"
#include "core/elementary/question/test_queries.h"

namespace cscd {
namespace {

using test::FourMovingPoints;
using test::query_of;
using test::QueryMaker;

constexpr unsigned kAllCases = (1 << 9) - 1;

// Holds the decision, and the stage of integers by itself, against the oracle.
struct Ties {
  int apart = 0, at_start = 0, later = 0, all = 0;
  int integers_gave_up = 0;
  std::map<ExactStage, int> stages;

  template <class Query>
  void add(const FourMovingPoints& points, double r) {
    const Query query = query_of<Query>(points);
    const auto truth = exact::first_closeness(query, r);
    const std::string what = test::text(points, "r = ", r);
    const bool close_at_start = truth && truth->hi == 0;
    ++all;
    ++(!truth ? apart : close_at_start ? at_start : later);

    Answer answer;
    filtered_exact_close(std::span(&query, 1), std::span(&r, 1), std::span(&answer, 1));
    ++stages[filtered_exact_close_stage(query, r)];
    ASSERT_EQ(answer.verdict, truth ? Verdict::contact : Verdict::apart) << what;
    if (truth) {
      ASSERT_EQ(answer.time, truth->lo) << what;
    }

    const int cases = std::is_same_v<Query, MovingVertexFace> ? 7 : 9;
    for (const int likely : {0, all % cases}) {
      const integer::Outcome start = integer::closeness_at_start(query, r, likely);
      if (start == integer::Outcome::gave_up) continue;
      ASSERT_EQ(start == integer::Outcome::contact, close_at_start) << what;
    }
    if (close_at_start) return;
    for (const unsigned asked : {kAllCases, possible_cases(query, r, 0)}) {
      const integer::Result found = integer::first_closeness(query, r, asked);
      integers_gave_up += found.outcome == integer::Outcome::gave_up;
      if (found.outcome == integer::Outcome::gave_up) continue;
      ASSERT_EQ(found.outcome == integer::Outcome::contact, truth.has_value()) << what;
      if (truth) {
        ASSERT_EQ(found.time, truth->lo) << what;
      }
    }
  }
  void add_both(const FourMovingPoints& points, double r) {
    add<MovingVertexFace>(points, r);
    if (!testing::Test::HasFatalFailure()) add<MovingEdgeEdge>(points, r);
  }
  int by_oracle() { return stages[ExactStage::oracle]; }
};

// Two features of a grid with edges of length `edge`, whose points are multiples of it, some edges apart.
FourMovingPoints of_grid(QueryMaker& make, double edge, bool flat) {
  const auto node = [&](int most) { return edge * make.below(most); };
  FourMovingPoints p;
  const Vec3 first(node(4), node(4), flat ? 0 : node(3)), second(node(4), node(4), flat ? 0 : node(3));
  const auto near = [&](const Vec3& from) {
    return test::still(from + Vec3(node(2), node(2), flat ? 0 : node(2)));
  };
  p = {test::still(first), near(first), near(second), near(second)};
  p[3].start[make.below(2)] += edge, p[3].end = p[3].start;
  return p;
}
double hair_off(QueryMaker& make, double x) {
  const int kind = make.below(3);
  return kind == 0 ? x : std::nextafter(x, kind == 1 ? 0 : 2 * x);
}

TEST(CloseIntegers, GridsAtAWholeNumberOfEdgesAreDecidedAsByTheOracle) {
  QueryMaker make(11);
  Ties at_rest, carried, turned;
  for (int i = 0; i < 2400; ++i) {
    const double edge = std::array{1.0, 0.1, 1.0 / 3, 0x1p-7, std::exp(make.uniform(-3, 3))}[make.below(5)];
    const double r = hair_off(make, edge * std::array{1.0, 2.0, 0.5, 3.0, std::sqrt(2)}[make.below(5)]);
    const FourMovingPoints grid = of_grid(make, edge, i % 2 == 0);
    ASSERT_NO_FATAL_FAILURE(at_rest.add_both(grid, r));
    const Vec3 to = 10 * edge * make.vector();
    ASSERT_NO_FATAL_FAILURE(carried.add_both(test::moved(grid, Vec3::Zero(), to), r));
    // A turn by a rational angle, and points that round: nearly a rigid motion from a tie.
    const double angle = make.uniform(-0.2, 0.2), c = std::cos(angle), s = std::sin(angle);
    FourMovingPoints turning = grid;
    for (MovingPoint& p : turning)
      p.end = Vec3(c * p.end.x() - s * p.end.y(), s * p.end.x() + c * p.end.y(), p.end.z()) + to;
    ASSERT_NO_FATAL_FAILURE(turned.add_both(turning, r));
  }
  for (Ties* ties : {&at_rest, &carried, &turned}) {
    EXPECT_GT(ties->at_start, ties->all / 10);
    EXPECT_GT(ties->apart, ties->all / 10);
    EXPECT_GT(ties->stages[ExactStage::integers], ties->all / 20);
    EXPECT_LT(ties->by_oracle(), ties->all / 200);
  }
  EXPECT_EQ(at_rest.by_oracle(), 0);
  EXPECT_GT(turned.later, 100);
}

// Features that come down to the distance, or rise from it, at t = 0, within, or at t = 1.
TEST(CloseIntegers, TiesAtBothEndsAndWithinAreDecidedAsByTheOracle) {
  QueryMaker make(12);
  Ties ties;
  for (int i = 0; i < 3000; ++i) {
    const double edge = make.below(2) ? 1.0 : 0.1, r = hair_off(make, edge);
    FourMovingPoints points = of_grid(make, edge, true);
    const double from =
                     std::array{
                         0.0, 1.0, 1.5, 2.0, std::nextafter(1.0, 0), std::nextafter(1.0, 2)}[make.below(6)],
                 to = std::array{0.0, 1.0, 1.5, 2.0, -1.0, 1 + 0x1p-40}[make.below(6)];
    const Vec3 drift = make.below(2) ? Vec3::Zero() : Vec3(edge * make.below(3), edge * make.below(3), 0);
    const std::size_t first = i % 2 == 0 ? 1 : 2;
    for (std::size_t k = 0; k < first; ++k) {
      points[k].start.z() = from * edge;
      points[k].end += drift;
      points[k].end.z() = to * edge;
    }
    ASSERT_NO_FATAL_FAILURE(first == 1 ? ties.add<MovingVertexFace>(points, r)
                                       : ties.add<MovingEdgeEdge>(points, r));
  }
  EXPECT_GT(ties.apart, 300);
  EXPECT_GT(ties.at_start, 300);
  EXPECT_GT(ties.later, 300);
  EXPECT_LT(ties.by_oracle(), 60);
}

TEST(CloseIntegers, DegenerateFeaturesAndGeneralOnesAreDecidedAsByTheOracle) {
  QueryMaker make(13);
  Ties lattice, general;
  for (int i = 0; i < 2000; ++i) {
    ASSERT_NO_FATAL_FAILURE(lattice.add_both(make.lattice(1 + i % 3), 0.5 * (1 + make.below(6))));
  }
  for (int i = 0; i < 500; ++i) ASSERT_NO_FATAL_FAILURE(general.add_both(make.any(), make.uniform(0.1, 1)));
  EXPECT_GT(lattice.later, 200);
  EXPECT_LT(lattice.by_oracle(), 100);
  EXPECT_GT(general.later, 100);
  // Nothing but a distance that is grazed is too much for the integers.
  EXPECT_LT(lattice.integers_gave_up, 400);
  EXPECT_EQ(general.integers_gave_up, 0);
}

// Coordinates of very different sizes need longer integers than there are, and then the oracle answers.
TEST(CloseIntegers, ExtremeExponentsAreDecidedAsByTheOracle) {
  QueryMaker make(14);
  Ties ties, mixed;
  for (const double size : {0x1p-1070, 0x1p-600, 0x1p-90, 0x1p90, 0x1p500, 0x1p1000})
    for (int i = 0; i < 60; ++i) {
      const FourMovingPoints grid = of_grid(make, 1, i % 2 == 0);
      FourMovingPoints points = test::moved(test::scaled(grid, size), Vec3::Zero(), size * make.vector());
      const double r = hair_off(make, size * (1 + make.below(2)));
      ASSERT_NO_FATAL_FAILURE(ties.add_both(points, r));
      points[static_cast<std::size_t>(make.below(4))].end[make.below(3)] *= 0x1p-300;
      points[static_cast<std::size_t>(make.below(4))].start[make.below(3)] += std::ldexp(size, -40);
      ASSERT_NO_FATAL_FAILURE(mixed.add_both(points, r));
    }
  EXPECT_GT(ties.at_start, 100);
  EXPECT_GT(ties.apart, 100);
  EXPECT_GT(mixed.integers_gave_up, 50);
  EXPECT_LT(mixed.integers_gave_up, mixed.all);
}

}  // namespace
}  // namespace cscd
