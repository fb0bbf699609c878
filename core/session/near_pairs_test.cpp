#include "core/session/near_pairs.h"

#include <cstdlib>
#include <gtest/gtest.h>
#include <random>

#include "core/base/test_allocations.h"
#include "core/detect/compose.h"
#include "core/detect/plain_culler.h"
#include "core/elementary/catalogue.h"
#include "core/fast/drvbc_fast.h"
#include "core/mesh/test_shapes.h"
#include "core/session/near_strategy.h"
#include "core/session/session.h"

namespace cscd {
namespace {

// How many steps each series has; more by CSCD_RANDOM_STEPS=10000.
int count() {
  const char* asked = std::getenv("CSCD_RANDOM_STEPS");
  return asked != nullptr ? std::atoi(asked) : 400;
}

// Two balls and an open sheet near each other, which move by small steps, each vertex a little otherwise.
class NearPairsTest : public testing::Test {
 protected:
  NearPairsTest() {
    shape_ =
        test::together(test::together(test::icosphere(2), test::moved(test::icosphere(2), {2.005, 0, 0})),
                       test::moved(test::sheet(6), {0, 0, 1.005}));
    mesh_.emplace(shape_.mesh());
  }
  Vec3 draw() { return Vec3(some_(random_), some_(random_), some_(random_)); }
  // Each piece moves on in a direction of its own and turns about its middle, which both change now and then.
  // Besides, the sheet bends and each vertex moves a little.
  std::vector<Vec3> next(std::span<const Vec3> from, double step, bool turn) {
    std::vector<Vec3> out(from.begin(), from.end());
    for (std::size_t piece = 0; piece < 3; ++piece) {
      if (turn) ways_[piece] = draw(), spins_[piece] = 2 * draw();
      const std::size_t first = 162 * piece, last = piece < 2 ? first + 162 : out.size();
      Vec3 middle = Vec3::Zero();
      for (std::size_t v = first; v < last; ++v) middle += from[v] / static_cast<double>(last - first);
      const Vec3 spin = step * spins_[piece];
      const Eigen::AngleAxisd turned(spin.norm(), spin.norm() > 0 ? spin.normalized() : Vec3::UnitX());
      for (std::size_t v = first; v < last; ++v) {
        const Vec3 seen = from[v] - middle;
        out[v] = middle + turned * seen + step * (ways_[piece] + 0.3 * draw());
        if (piece == 2) out[v] += step * spins_[piece].y() * seen.squaredNorm() * turned.axis();
      }
    }
    return out;
  }
  StrategyInput setup(bool first) const {
    return {.mesh = *mesh_,
            .reference = shape_.positions,
            .rig = nullptr,
            .elementary = *find_elementary_test("filtered_exact"),
            .first_only = first};
  }
  Session session(bool first, NearPairs* near, const Thickness& thickness) const {
    return {"test",
            setup(first),
            kDrvbcFastComplete,
            kDrvbcFastComplete,
            shape_.positions,
            {.first = first, .keep_rest_crossings = true, .near = near, .thickness = thickness}};
  }

  std::mt19937 random_{7};
  std::uniform_real_distribution<double> some_{-1, 1};
  test::Shape shape_;
  std::optional<TriangleMesh> mesh_;
  std::array<Vec3, 3> ways_, spins_;
};

std::vector<std::tuple<FeaturePair, double>> told(const ContactSet& found) {
  std::vector<std::tuple<FeaturePair, double>> out;
  for (const Contact& contact : found.contacts) out.emplace_back(contact.pair, contact.time);
  return out;
}

// Steps that follow each other, trial steps from one start, steps back and leaps: the answers are those of a
// session without a list.
TEST_F(NearPairsTest, AnswerAsTheStrategiesDo) {
  std::vector<double> of_vertex(mesh_->vertex_count());
  for (double& r : of_vertex) r = 0.004 * std::abs(some_(random_));
  for (const Thickness& thickness : {Thickness(), Thickness(0.01), Thickness(0.001, of_vertex)})
    for (const bool first : {false, true}) {
      NearPairs near(*mesh_, shape_.positions, thickness);
      Session with = session(first, &near, thickness), without = session(first, nullptr, thickness);
      std::vector<Vec3> start = shape_.positions, end;
      std::size_t touching = 0, steps = 0;
      StepAnswer a, b, c;
      for (int n = 0; n < count(); ++n) {
        SCOPED_TRACE(testing::Message() << n << " thickness " << thickness.largest() << " first " << first);
        const double size = n % 50 == 49 ? 0.3 : n % 7 == 0 ? 1e-2 : 5e-3;
        end = next(start, size, n % 25 == 0);
        with.step({start, end}, nullptr, a);
        without.step({start, end}, nullptr, b);
        ASSERT_EQ(told(a.found), told(b.found));
        if (first) {
          with.step({start, end}, nullptr, c, Session::Sought::any_contact);
          ASSERT_EQ(c.found.contacts.empty(), b.found.contacts.empty());
          with.step({start, end}, nullptr, c, Session::Sought::time);
          ASSERT_EQ(c.time().has_value(), b.time().has_value());
          if (b.time()) {
            ASSERT_NEAR(*c.time(), *b.time(), 0x1p-42);
          }
        }
        ASSERT_EQ(a.start.pairs, b.start.pairs);
        ASSERT_EQ(a.proven, b.proven);
        touching += !a.found.contacts.empty();
        ++steps;
        if (n % 5 == 3) std::swap(start, end);  // asks about the way back, and goes on from the same start
        if (n % 5 != 4) start = end;
        if (n % 50 == 49) start = shape_.positions;
      }
      EXPECT_GT(touching, steps / 20);
      EXPECT_GT(near.anchors(), 2u);
      EXPECT_LT(near.anchors(), steps / 4);
      EXPECT_GT(near.lists(), near.anchors());
    }
}

// Where something is close in every step, the first contact says nothing of the end, and so the start of the
// next step is not known. Mutation: only steps from known starts are answered by a list.
TEST_F(NearPairsTest, AnswerFromStartsThatAreNotKnown) {
  const Thickness thickness(0.01);  // the balls are 0.005 apart
  NearPairs near(*mesh_, shape_.positions, thickness);
  Session with = session(true, &near, thickness), without = session(true, nullptr, thickness);
  std::vector<Vec3> start = shape_.positions, end;
  StepAnswer a, b;
  int by_list = 0;
  for (int n = 0; n < 100; ++n) {
    SCOPED_TRACE(n);
    end = next(start, 1e-5, n % 25 == 0);
    with.step({start, end}, nullptr, a);
    without.step({start, end}, nullptr, b);
    ASSERT_FALSE(b.found.contacts.empty());
    ASSERT_EQ(told(a.found), told(b.found));
    ASSERT_EQ(a.start.pairs, b.start.pairs);
    by_list += *a.report.cull.bvot == 0;
    start = end;
  }
  EXPECT_GT(by_list, 90);
}

// The strategy of a benchmark keeps one list for a thickness, and makes another where that changes. Mutation:
// a list for each step.
TEST_F(NearPairsTest, LastWhileTheThicknessDoes) {
  const StrategyInput input = setup(false);
  const Prepared prepared = make_drvbc_fast_near(input), plain = kDrvbcFastComplete.make(input);
  std::vector<Vec3> start = shape_.positions;
  ContactSet found, expected;
  int by_list = 0;
  for (int n = 0; n < 60; ++n) {
    SCOPED_TRACE(n);
    const std::vector<Vec3> end = next(start, 1e-5, n == 0);
    const Step step{.motion = Motion(start, end), .thickness = Thickness(n < 30 ? 0.01 : 0.02)};
    by_list += *prepared.detector->detect(step, found).cull.bvot == 0;
    plain.detector->detect(step, expected);
    found.sort(), expected.sort();
    ASSERT_EQ(told(found), told(expected));
    start = end;
  }
  EXPECT_GT(by_list, 50);
}

// A strategy for known starts cannot find what is near. A complete one is prepared for that once there were
// so many small steps that they have taken about as long. Mutation: the first small step prepares it.
TEST(NearPairs, ComeAfterManySmallStepsFromKnownStarts) {
  const test::Shape balls =
      test::together(test::icosphere(2), test::moved(test::icosphere(2), {2.005, 0, 0}));
  const TriangleMesh mesh = balls.mesh();
  const StrategyInput setup{.mesh = mesh,
                            .reference = balls.positions,
                            .rig = nullptr,
                            .elementary = *find_elementary_test("filtered_exact"),
                            .first_only = true};
  NearPairs near(mesh, balls.positions, {});
  const auto session = [&](NearPairs* list) {
    return Session("test", setup, kDrvbcFast, kDrvbcFastComplete, balls.positions,
                   {.first = true, .keep_rest_crossings = true, .near = list});
  };
  Session with = session(&near), without = session(nullptr);
  std::vector<Vec3> start = balls.positions;
  StepAnswer a, b;
  int before_first = 0, touching = 0;
  for (int n = 0; n < 600; ++n) {
    SCOPED_TRACE(n);
    std::vector<Vec3> end = start;
    for (std::size_t v = 0; v < end.size() / 2; ++v) end[v].x() += n < 550 ? 8e-6 : 8e-5;
    with.step({start, end}, nullptr, a);
    without.step({start, end}, nullptr, b);
    ASSERT_EQ(told(a.found), told(b.found));
    ASSERT_EQ(a.proven, b.proven);
    before_first += near.anchors() == 0;
    touching += !a.found.contacts.empty();
    if (a.found.contacts.empty()) start = std::move(end);
  }
  EXPECT_GT(before_first, 200);
  EXPECT_LT(before_first, 300);
  EXPECT_GT(touching, 10);
}

// Pieces that turn far while they stay as they are near each other. Where the whole turns, the first list
// lasts (mutation: lists know shifts alone); where each piece turns otherwise, one anchor serves many lists.
TEST_F(NearPairsTest, FollowWhatTurns) {
  for (const bool whole : {true, false}) {
    NearPairs near(*mesh_, shape_.positions, {});
    Session with = session(false, &near, {}), without = session(false, nullptr, {});
    std::vector<Vec3> start = shape_.positions;
    StepAnswer a, b;
    std::size_t touching = 0;
    for (int n = 0; n < 300; ++n) {
      SCOPED_TRACE(testing::Message() << n << " whole " << whole);
      const auto middle = [&](std::size_t piece) {
        Vec3 sum = Vec3::Zero();
        for (std::size_t v = 0; v < 162; ++v) sum += start[162 * piece + v];
        return Vec3(sum / 162);
      };
      const Vec3 between = (middle(1) - middle(0)).normalized();
      const Vec3 way = (n % 100 < 50 ? 3e-4 : -3e-4) * between;
      std::vector<Vec3> end = start;
      for (std::size_t v = 0; v < end.size(); ++v) {
        const double angle = whole ? 0.01 : v < 162 ? 1e-3 : -1e-3;
        const Eigen::AngleAxisd turn(angle, whole ? Vec3(1, 2, 2) / 3 : between);
        const Vec3 about = whole ? Vec3::Zero() : middle(0);
        end[v] = about + turn * Vec3((v < 162 ? start[v] + way : start[v]) - about);
      }
      with.step({start, end}, nullptr, a);
      without.step({start, end}, nullptr, b);
      ASSERT_EQ(told(a.found), told(b.found));
      touching += !a.found.contacts.empty();
      start = std::move(end);
    }
    EXPECT_GT(touching, 4u);
    EXPECT_LT(near.anchors(), whole ? 2u : 8u);
    if (whole)
      EXPECT_LT(near.lists(), 3u);
    else
      EXPECT_GT(near.lists(), 12u);
  }
}

// Where memory runs out, whatever is asked next is answered as by a session without a list.
TEST_F(NearPairsTest, AnswerAfterMemoryRanOut) {
  Session without = session(false, nullptr, {});
  StepAnswer a, b;
  std::size_t failed = 0;
  for (std::size_t failing = 1; failing < 1000; failing = failing + 1 + failing / 8) {
    SCOPED_TRACE(failing);
    NearPairs near(*mesh_, shape_.positions, {});
    Session with = session(false, &near, {});
    std::vector<Vec3> start = shape_.positions;
    bool has_failed = false;
    for (std::size_t n = 0; n < 30; ++n) {
      const std::vector<Vec3> end = next(start, 5e-3, n == 0);
      if (n >= 5 + failing % 5 && !has_failed) g_failing = g_allocations + failing;
      try {
        with.step({start, end}, nullptr, a);
      } catch (const std::bad_alloc&) {
        has_failed = true;
        with.step({start, end}, nullptr, a);
      }
      g_failing = 0;
      without.step({start, end}, nullptr, b);
      ASSERT_EQ(told(a.found), told(b.found));
      start = end;
    }
    failed += has_failed;
    EXPECT_GT(near.anchors(), 0u);
  }
  EXPECT_GT(failed, 10u);
}

// Sheets that lie so densely that a list cannot hold all that is near: every other one moves towards its
// neighbour below, half of them from twice as far. Those are given up, and are farther than the list reaches.
TEST_F(NearPairsTest, ReachLessFarWhereMuchIsNear) {
  constexpr std::size_t kSheets = 12, kVertices = 49;
  shape_ = {};
  for (std::size_t k = 0; k < kSheets; ++k) {
    const double lower = static_cast<double>(k / 2), gap = k % 4 == 1 ? 0.004 : 0.008;
    const test::Shape sheet =
        test::moved(test::sheet(6), {0.01 * draw().x(), 0, 0.1 * lower + (k % 2 == 1 ? gap : 0)});
    shape_ = k == 0 ? sheet : test::together(shape_, sheet);
  }
  mesh_.emplace(shape_.mesh());
  NearPairs near(*mesh_, shape_.positions, {});
  Session with = session(false, &near, {}), without = session(false, nullptr, {});
  std::vector<Vec3> start = shape_.positions;
  std::size_t touching = 0;
  StepAnswer a, b;
  for (int n = 0; n < count(); ++n) {
    SCOPED_TRACE(n);
    if (n % 40 == 0) start = shape_.positions;
    std::vector<Vec3> end = start;
    for (std::size_t v = 0; v < end.size(); ++v)
      end[v].z() += (v / kVertices % 2 == 0 ? 1 : -1) * 3e-4 * (1 + 0.1 * draw().x());
    with.step({start, end}, nullptr, a);
    without.step({start, end}, nullptr, b);
    ASSERT_EQ(told(a.found), told(b.found));
    touching += !a.found.contacts.empty();
    start = std::move(end);
  }
  EXPECT_GT(touching, 10u);
  EXPECT_GT(near.anchors(), 0u);
}

// The bound is spent to the last digit: a vertex that moves from just beyond the reach of a list touches, or
// is close.
TEST_F(NearPairsTest, HoldWhatComesFromTheEndOfTheirReach) {
  const std::vector<Triangle> faces{test::corners(0, 1, 2), test::corners(3, 4, 5)};
  const TriangleMesh mesh(faces, 6, "two triangles");
  for (int n = 0; n < count() / 2; ++n) {
    SCOPED_TRACE(n);
    // The first triangle rises by small steps until it meets the second, which comes down as fast; every
    // other time each vertex has a speed of its own.
    const Thickness thickness(n % 3 == 0 ? 0.05 : 0);
    const double gap = 0.4 + 0.5 * std::abs(some_(random_)), step = 0.01 * (0.2 + std::abs(some_(random_)));
    const std::vector<Vec3> rest{{0, 0, 0},       {1, 0, 0},       {0, 1, 0},
                                 {0.2, 0.2, gap}, {1.2, 0.2, gap}, {0.2, 1.2, gap}};
    std::vector<Vec3> start = rest;
    std::vector<Vec3> way(6);
    for (std::size_t v = 0; v < 6; ++v) {
      const double speed = n % 2 == 0 ? 1 : std::abs(some_(random_));
      way[v] = Vec3(0, 0, (v < 3 ? step / 2 : -step / 2) * speed);
    }
    const StrategyInput setup{mesh, rest, nullptr, *find_elementary_test("filtered_exact")};
    NearPairs near(mesh, rest, thickness);
    const auto made = [&](NearPairs* list) {
      return Session("test", setup, kDrvbcFastComplete, kDrvbcFastComplete, rest,
                     {.keep_rest_crossings = true, .near = list, .thickness = thickness});
    };
    Session with = made(&near), without = made(nullptr);
    StepAnswer a, b;
    bool touched = false;
    for (int steps = 0; steps < 600 && !touched; ++steps) {
      std::vector<Vec3> end = start;
      for (std::size_t v = 0; v < 6; ++v) end[v] += way[v];
      with.step({start, end}, nullptr, a);
      without.step({start, end}, nullptr, b);
      ASSERT_EQ(told(a.found), told(b.found)) << steps;
      touched = !b.found.contacts.empty();
      start = std::move(end);
    }
    EXPECT_TRUE(touched || n % 2 == 1);
    EXPECT_GT(near.anchors(), 0u);
  }
}

}  // namespace
}  // namespace cscd
