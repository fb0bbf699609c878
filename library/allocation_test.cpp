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
      pose.row(v) = (1 + 0.1 * i) * ball.positions[static_cast<std::size_t>(v)];
    poses.push_back(pose);
  }
  SelfCollision body(faces, poses[0]);
  SelfCollision::Answer answer;
  body.first_contact(poses[0], poses[1], answer);
  body.first_contact(poses[1], poses[2], answer);
  for (std::size_t i = 2; i + 1 < poses.size(); ++i) {
    const std::size_t before = g_allocations;
    body.first_contact(poses[i], poses[i + 1], answer);
    EXPECT_EQ(g_allocations - before, 0u) << i;
    EXPECT_TRUE(answer.free());
  }
  const std::size_t before = g_allocations;
  body.all_contacts(poses[0], poses[5], answer);
  EXPECT_GT(g_allocations - before, 0u) << "allocations are counted";
}

}  // namespace
}  // namespace cscd
