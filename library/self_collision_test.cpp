#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <random>
#include <set>
#include <thread>

#include "core/fast/drvbc_fast.h"
#include "core/session/session.h"
#include "library/test_steps.h"

// Holds every answer of the library to a search of all feature pairs with the exact test.
namespace cscd {
namespace {

using namespace test;

TEST(SelfCollision, AnswersRandomStepsAsASearchOfAllFeaturePairsDoes) {
  std::size_t free = 0, crossing = 0;
  for (std::uint64_t seed = 1; seed <= intervals(); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const SceneStep step(seed);
    SelfCollision body(step.faces, step.start);
    EXPECT_EQ(body.closed(), step.mesh.closed_and_oriented());
    expect_right(step, body, {});
    const SelfCollision::Answer answer = body.first_contact(step.start, step.end);
    free += answer.free();
    crossing += answer.intersects_at_start();
    if (testing::Test::HasFailure()) return;
  }
  EXPECT_GT(free, intervals() / 20);
  EXPECT_GT(crossing, intervals() / 20);
}

// Mutations: a start that differs in one bit is taken for the same; an end that is not finite is not refused.
TEST(SelfCollision, IsFreeKnowsACrossingStartWhenAskedAgain) {
  std::size_t crossing = 0;
  for (std::uint64_t seed = 1; seed <= intervals(); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const SceneStep step(seed);
    SelfCollision body(step.faces, step.start);
    const auto expect_as_new = [&](const Rows& start, const Rows& end) {
      EXPECT_EQ(body.is_free(start, end), SelfCollision(step.faces, step.start).is_free(start, end));
    };
    for (int call = 0; call < 3; ++call) expect_as_new(step.start, step.end);
    expect_as_new(step.start, step.start);
    expect_as_new(step.end, step.start);
    expect_as_new(step.start, step.end);
    if (!body.first_contact(step.start, step.end).intersects_at_start()) continue;
    ++crossing;
    Rows broken = step.end;
    broken(0, 1) = std::nan("");
    EXPECT_THROW(body.is_free(step.start, broken), std::invalid_argument);
    // Components that are pulled apart may start free.
    Rows apart = step.start;
    for (Eigen::Index v = 0; v < apart.rows(); ++v) {
      const auto at = step.mesh.triangles_at(VertexId{static_cast<std::int32_t>(v)});
      apart(v, 2) += 1e3 * (at.empty() ? -1 : step.mesh.component(at[0]));
    }
    expect_as_new(apart, apart);
    EXPECT_FALSE(body.is_free(step.start, step.end));
    if (testing::Test::HasFailure()) return;
  }
  EXPECT_GT(crossing, intervals() / 20);
}

// Candidates are all pairs that come within the radius, and none whose boxes do not, found here from all
// pairs. Mutations: a radius of 0 takes what touches last; the culler is not told the radius.
TEST(SelfCollision, GivesAllCandidates) {
  std::size_t seen = 0, fewer = 0;
  for (std::uint64_t seed = 1; seed <= intervals() / 4; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const SceneStep step = seed % 2 == 0 ? SceneStep(seed) : beside(seed);
    const bool obstacle = step.own() < step.mesh.vertex_count();
    const Exclusions exclusions = obstacle ? obstacle_against_obstacle(step) : Exclusions();
    SelfCollision::Options options;
    if (obstacle) options.obstacles.push_back(obstacle_of(step, step.beside(step.all_start)));
    SelfCollision body(step.faces, step.start, options);
    if (obstacle) body.move_obstacle(0, step.beside(step.all_start), step.beside(step.all_end));
    for (const double radius : {0.0, 0.05, 0.5}) {
      std::set<std::array<int, 4>> edge_edge;  // whose boxes are near enough, but for roundings
      std::set<std::array<int, 2>> vertex_face;
      for_each_feature_pair(
          step.mesh, step.motion(), [&](const FeaturePair& pair, const Box& a, const Box& b) {
            const double gap = std::max((a.min() - b.max()).maxCoeff(), (b.min() - a.max()).maxCoeff());
            if (gap > radius * (1 + 1e-12) || exclusions.excludes(step.mesh, pair)) return;
            if (pair.kind == FeaturePair::Kind::vertex_face)
              vertex_face.insert({pair.a, pair.b});
            else
              edge_edge.insert(indices_of(step.mesh, pair));
          });
      const SelfCollision::Candidates got = body.candidates(step.start, step.end, radius);
      const std::set got_vertex_face(got.vertex_face.begin(), got.vertex_face.end());
      const std::set got_edge_edge(got.edge_edge.begin(), got.edge_edge.end());
      EXPECT_EQ(got.vertex_face.size(), got_vertex_face.size()) << "each pair once";
      EXPECT_EQ(got.edge_edge.size(), got_edge_edge.size());
      seen += got.vertex_face.size();
      EXPECT_TRUE(std::ranges::includes(vertex_face, got_vertex_face));
      EXPECT_TRUE(std::ranges::includes(edge_edge, got_edge_edge));
      fewer += got_edge_edge.size() < edge_edge.size();
      for (const auto& [key, time] : truth_of(step, exclusions, Thickness(radius))) {
        const auto& [edges, vertices, face] = key;
        EXPECT_TRUE(edges ? got_edge_edge.contains(vertices) : got_vertex_face.contains({vertices[0], face}));
      }
    }
  }
  EXPECT_GT(seen, 1000u);
  EXPECT_GT(fewer, intervals() / 8);
}

// One object that answers a thousand steps, in any order, gives the answers of fresh objects: where the next
// step follows the last one, begins where it began, leads back or begins anywhere.
TEST(SelfCollision, RemembersNothingThatChangesAnAnswer) {
  std::size_t free = 0, crossing = 0, steps = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const SceneStep step(seed);
    SelfCollision body(step.faces, step.start);
    std::vector<Rows> poses;
    for (const double at : {0.0, 0.01, 0.05, 0.1, 0.5, 1.0})
      poses.push_back((1 - at) * step.start + at * step.end);
    std::mt19937_64 random(seed);
    std::size_t from = 0, to = 1;
    for (int i = 0; i < 84; ++i, ++steps) {
      SelfCollision fresh(step.faces, step.start);
      const SelfCollision::Answer expected = fresh.all_contacts(poses[from], poses[to]);
      if (i % 3 > 0) {
        EXPECT_EQ(body.first_contact(poses[from], poses[to]).time(), expected.time()) << seed << ", " << i;
      }
      if (i % 3 != 1) {
        const SelfCollision::Answer got = body.all_contacts(poses[from], poses[to]);
        EXPECT_EQ(found(got), found(expected)) << seed << ", " << i;
        EXPECT_EQ(got.start_crossings, expected.start_crossings) << seed << ", " << i;
      }
      free += expected.free();
      crossing += expected.intersects_at_start();
      const std::size_t kind = random() % 4, any = random() % poses.size();
      if (kind == 0) std::swap(from, to);
      if (kind == 1) from = to;
      if (kind == 2) from = random() % poses.size();
      if (kind > 0) to = any;
    }
  }
  EXPECT_GT(free, steps / 10);
  EXPECT_GT(crossing, steps / 10);
}

// Whether a step is free and how far it is free do not depend on what touched before, with and without a
// thickness, and where what goes on is left out. Mutations: a pair that touches later in the step ends it at
// its start; what touched is asked though it is left out; the ends of other vertices are not looked at.
TEST(SelfCollision, KnowsWhatTouchedInTheStepBefore) {
  std::size_t free = 0, at_start = 0, later = 0, steps = 0;
  for (std::uint64_t seed = 1; seed <= 36; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const SceneStep step(seed);
    SelfCollision::Options options;
    if (seed % 3 == 1) options.thickness = 0.05;
    options.exclude.ongoing = seed % 3 == 2;
    SelfCollision body(step.faces, step.start, options);
    std::mt19937_64 random(seed);
    Rows from = step.start;
    for (int i = 0; i < 30; ++i, ++steps) {
      const double share = std::uniform_real_distribution(-0.1, 0.3)(random);
      const Rows to = from + share * (step.end - step.start);
      SelfCollision fresh(step.faces, step.start, options);
      const double expected = fresh.largest_step(from, to, 1);
      EXPECT_EQ(body.is_free(from, to), fresh.is_free(from, to)) << i;
      EXPECT_NEAR(body.largest_step(from, to, 1), expected, 0x1p-40) << i;  // the time to a share of 2^-42
      free += expected == 1;
      at_start += expected == 0;
      later += expected > 0 && expected < 1;
      Rows broken = to;
      broken(static_cast<Eigen::Index>(random() % static_cast<std::size_t>(to.rows())), 1) = std::nan("");
      EXPECT_THROW(body.is_free(from, broken), std::invalid_argument);
      EXPECT_THROW(body.largest_step(broken, to, 1), std::invalid_argument);
      if (i % 4 > 0) from = to;
    }
  }
  EXPECT_GT(free, steps / 20);
  EXPECT_GT(at_start, steps / 20);
  EXPECT_GT(later, steps / 20);
}

// Sessions on several threads over one const mesh answer as each would alone.
TEST(SelfCollision, SessionsOnSeveralThreadsShareOneMesh) {
  const ElementaryTest& exact = *find_elementary_test("filtered_exact");
  const auto make = [](const StrategyInput& setup) {
    return make_drvbc_fast(setup, {.name = "drvbc_fast_complete", .complete = true});
  };
  const Strategy complete{"drvbc_fast_complete", "",  Guarantee::complete, Needs::any_mesh,
                          StrategyKind::fixed,   make};
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const SceneStep step(seed);
    const StrategyInput setup{step.mesh, step.all_start, nullptr, exact};
    const auto answers = [&] {
      Session session("mesh", setup, complete, complete, step.all_start, {.keep_rest_crossings = true});
      std::vector<std::string> out;
      StepAnswer answer;
      for (int i = 0; i < 20; ++i) {
        session.step(i % 2 == 0 ? step.motion() : Motion(step.all_end, step.all_start), nullptr, answer);
        out.push_back(digest(answer.found) + std::to_string(answer.start.total));
      }
      return out;
    };
    const std::vector<std::string> expected = answers();
    std::vector<std::vector<std::string>> got(4);
    std::vector<std::thread> threads;
    for (auto& one : got) threads.emplace_back([&one, &answers] { one = answers(); });
    for (std::thread& thread : threads) thread.join();
    for (const auto& one : got) EXPECT_EQ(one, expected);
  }
}

// Triangles are added and removed by preparing the object anew.
TEST(SelfCollision, IsPreparedAnewForOtherTriangles) {
  const SceneStep step(2);
  SelfCollision body(step.faces, step.start);
  for (const Eigen::Index left : {step.faces.rows() - 1, step.faces.rows() / 2, step.faces.rows()}) {
    body = SelfCollision(step.faces.topRows(left), step.start);
    SelfCollision fresh(step.faces.topRows(left), step.start);
    EXPECT_EQ(body.face_count(), static_cast<std::size_t>(left));
    EXPECT_EQ(found(body.all_contacts(step.start, step.end)),
              found(fresh.all_contacts(step.start, step.end)));
  }
  EXPECT_EQ(found(body.all_contacts(step.start, step.end)), truth_of(step, {}));
}

// A body goes along an arc about the origin, and another one lies half-way on the arc, or on the line between
// its ends. Mutation: the bound of the acceleration is not used.
TEST(SelfCollision, AnswersPathsThatAreNoLines) {
  using Verdict = SelfCollision::PathsAnswer::Verdict;
  constexpr double kTurn = 2;
  const Rows corners =
      0.5 * Rows{{-0.25, -0.25, -0.25}, {0.75, -0.25, -0.25}, {-0.25, 0.75, -0.25}, {-0.25, -0.25, 0.75}};
  const FaceRows faces{{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3},
                       {4, 6, 5}, {4, 5, 7}, {4, 7, 6}, {5, 6, 7}};
  for (const double reach : {3.0, 3 * std::cos(kTurn / 2)}) {
    Rows rest(8, 3);
    rest << corners.rowwise() + Eigen::RowVector3d(3, 0, 0),
        corners.rowwise() + reach * Eigen::RowVector3d(std::cos(kTurn / 2), std::sin(kTurn / 2), 0);
    const auto at = [&](double time) {
      Rows out = rest;
      const Eigen::Matrix3d turned(Eigen::AngleAxisd(kTurn * time, Eigen::Vector3d::UnitZ()));
      out.topRows(4) = rest.topRows(4) * turned.transpose();
      return std::vector<double>(out.data(), out.data() + out.size());
    };
    SelfCollision body(faces, rest);
    const SelfCollision::Paths paths{at, [](double, double) { return std::vector{3.7 * kTurn * kTurn}; },
                                     1e-14};
    EXPECT_EQ(body.is_free(at(0), at(1)), reach == 3);
    const SelfCollision::PathsAnswer answer = body.true_motion(paths, 0, 1);
    EXPECT_EQ(answer.verdict, reach == 3 ? Verdict::touches : Verdict::clear);
    EXPECT_LT(answer.verdict == Verdict::touches ? answer.to - answer.from : 0, 1.0 / 255);
    EXPECT_THROW(body.true_motion({at, nullptr, 0}, 0, 1), std::invalid_argument);
    EXPECT_THROW(body.true_motion(paths, 1, 1), std::invalid_argument);
  }
}

}  // namespace
}  // namespace cscd
