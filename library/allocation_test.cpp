#include <cmath>
#include <gtest/gtest.h>
#include <new>
#include <random>
#include <vector>

#include "core/base/test_allocations.h"
#include "core/mesh/test_shapes.h"
#include "library/test_steps.h"

#include "cscd/cscd.h"

namespace cscd {
namespace {

using Rows = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;

// A ball that breathes: every step starts where a free step ended. Mutation: the end of a step is forgotten.
TEST(SelfCollision, AllocatesNothingInAFreeStepAfterAFreeStep) {
  const test::Shape ball = test::icosphere(3);
  const auto faces = test::face_rows(ball.triangles);
  // A piece of the ball, whose faces have vertices of their own.
  test::FaceRows small_faces(20, 3);
  Rows small(60, 3);
  for (Eigen::Index f = 0; f < 20; ++f)
    for (Eigen::Index k = 0; k < 3; ++k) {
      small_faces(f, k) = static_cast<int>(3 * f + k);
      small.row(3 * f + k) = ball.positions[static_cast<std::size_t>(faces(f, k))];
    }
  std::vector<Rows> poses;
  for (int i = 0; i < 6; ++i) {
    Rows pose(static_cast<Eigen::Index>(ball.positions.size()), 3);
    for (Eigen::Index v = 0; v < pose.rows(); ++v)
      pose.row(v) = (1 + 0.3 * (i % 2)) * ball.positions[static_cast<std::size_t>(v)];
    poses.push_back(pose);
  }
  // Alone; with a filter; beside obstacles in the distance, in reach of the ball's box, and moving.
  SelfCollision::Options plain, filter, beside;
  filter.exclude.rings = 1;
  for (const double away : {10.0, 1.4, -1.4})
    beside.obstacles.emplace_back(small_faces, Rows(0.2 * small.array() + away));
  for (const SelfCollision::Options& options : {plain, filter, beside}) {
    SelfCollision body(faces, poses[0], options);
    SelfCollision::Answer answer;
    for (std::size_t i = 0; i + 1 < poses.size(); ++i) {
      if (!options.obstacles.empty())
        body.move_obstacle(2, 0.2 * small.array() - 1.4, 0.2 * small.array() - 1.41);
      const std::size_t before = g_allocations;
      body.first_contact(poses[i], poses[i + 1], answer);
      if (i >= 2) {  // it has seen its largest steps
        EXPECT_EQ(g_allocations - before, 0u) << i;
      }
      EXPECT_TRUE(answer.free());
    }
  }
  SelfCollision body(faces, poses[0]);
  SelfCollision::Answer answer;
  const std::size_t before = g_allocations;
  body.all_contacts(poses[0], poses[5], answer);
  EXPECT_GT(g_allocations - before, 0u) << "allocations are counted";
}

// Memory may run out in the middle of a step; the next ones are answered right. Mutations: clusters whose
// cutting was broken off stay as they are; edges that were counted on the way stay counted; the end of a step
// is known before all that touched is kept; a search for crossings that was broken off leaves its marks.
TEST(SelfCollision, AnswersRightAfterAllocationsThatFailed) {
  std::size_t failed = 0;
  for (std::uint64_t seed = 1; seed <= test::intervals(); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const test::SceneStep step(seed);
    std::mt19937_64 random(seed);
    SelfCollision body(step.faces, step.start);
    SelfCollision::Answer answer;
    for (int i = 0; i < 40; ++i) {
      // A share of the way, and back, so that clusters follow the surface.
      const double share = std::uniform_real_distribution(-2.0, 2.0)(random);
      const test::Rows elsewhere = step.start + share * (step.end - step.start);
      const test::Rows &from = i % 2 == 0 ? elsewhere : step.start, &to = i % 2 == 0 ? step.end : elsewhere;
      g_failing = g_allocations + std::uint64_t(std::exp(std::uniform_real_distribution(0.0, 7.0)(random)));
      try {
        body.all_contacts(from, to, answer);
        g_failing = 0;
      } catch (const std::bad_alloc&) {
        g_failing = 0;
        ++failed;
        SelfCollision fresh(step.faces, step.start);
        const SelfCollision::Answer got = body.all_contacts(to, from),
                                    expected = fresh.all_contacts(to, from);
        EXPECT_EQ(test::found(got), test::found(expected));
        EXPECT_EQ(got.start_crossings, expected.start_crossings);
      }
    }
    // What was marked on a surface that crosses itself is no longer marked.
    const auto expected = SelfCollision(step.faces, step.start).crossings(step.end).overlaps;
    for (int i = 0; i < 10; ++i) {
      g_failing = g_allocations + std::uint64_t(std::exp(std::uniform_real_distribution(0.0, 6.0)(random)));
      try {
        body.crossings(step.end);
      } catch (const std::bad_alloc&) {
      }
      g_failing = 0;
      const auto got = body.crossings(step.end).overlaps;
      ASSERT_EQ(got.size(), expected.size());
      for (std::size_t k = 0; k < got.size(); ++k) {
        ASSERT_EQ(got[k].regions.size(), expected[k].regions.size());
        for (std::size_t r = 0; r < got[k].regions.size(); ++r)
          EXPECT_EQ(got[k].regions[r].vertices, expected[k].regions[r].vertices);
      }
    }
    test::expect_right(step, body, Exclusions());
    SelfCollision::Options options;
    options.preparation = body.preparation();
    EXPECT_NO_THROW(SelfCollision(step.faces, step.start, options));
    if (testing::Test::HasFailure()) return;
  }
  EXPECT_GT(failed, 5 * test::intervals());
}

}  // namespace
}  // namespace cscd
