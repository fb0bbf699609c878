#include <gtest/gtest.h>
#include <vector>

#include "core/base/test_allocations.h"
#include "core/mesh/test_shapes.h"

#include "cscd/cscd.h"

namespace cscd {
namespace {

using Rows = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;

// A ball that breathes: every step starts where a free step ended. Mutation: the end of a step is forgotten.
TEST(SelfCollision, AllocatesNothingInAFreeStepAfterAFreeStep) {
  const test::Shape ball = test::icosphere(3);
  Eigen::Matrix<int, Eigen::Dynamic, 3, Eigen::RowMajor> faces(
      static_cast<Eigen::Index>(ball.triangles.size()), 3);
  for (Eigen::Index f = 0; f < faces.rows(); ++f)
    for (int k = 0; k < 3; ++k)
      faces(f, k) =
          static_cast<int>(ball.triangles[static_cast<std::size_t>(f)][static_cast<std::size_t>(k)]);
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
    beside.obstacles.emplace_back(faces.topRows(20), Rows(0.2 * poses[0].array() + away));
  for (const SelfCollision::Options& options : {plain, filter, beside}) {
    SelfCollision body(faces, poses[0], options);
    SelfCollision::Answer answer;
    for (std::size_t i = 0; i + 1 < poses.size(); ++i) {
      if (!options.obstacles.empty())
        body.move_obstacle(2, 0.2 * poses[0].array() - 1.4, 0.2 * poses[0].array() - 1.41);
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

}  // namespace
}  // namespace cscd
