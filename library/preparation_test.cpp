#include <gtest/gtest.h>

#include "library/test_steps.h"

namespace cscd {
namespace {

using namespace test;

// Mutation: the observers of the second cover are those of the first.
TEST(SelfCollision, AnswersTheSameFromASavedPreparation) {
  for (std::uint64_t seed = 1; seed <= intervals(); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Step step(seed);
    SelfCollision first(step.faces, step.start);
    SelfCollision::Options options;
    options.preparation = first.preparation();
    ASSERT_FALSE(options.preparation.empty());
    SelfCollision again(step.faces, step.start, options);
    expect_right(step, again, Exclusions());
    if (testing::Test::HasFailure()) return;
    // What has followed the surface can be saved too.
    SelfCollision::Options followed;
    followed.preparation = again.preparation();
    SelfCollision third(step.faces, step.start, followed);
    expect_right(step, third, Exclusions());
    if (testing::Test::HasFailure()) return;
  }
}

TEST(SelfCollision, RefusesThePreparationOfAnotherMesh) {
  const Step step(1), other(2);
  SelfCollision::Options options;
  options.preparation = SelfCollision(step.faces, step.start).preparation();
  EXPECT_THROW(SelfCollision(other.faces, other.start, options), std::invalid_argument);
  Rows moved = step.start;
  moved(3, 1) += 1e-12;
  EXPECT_THROW(SelfCollision(step.faces, moved, options), std::invalid_argument);
  options.preparation.pop_back();
  EXPECT_THROW(SelfCollision(step.faces, step.start, options), std::invalid_argument);
}

}  // namespace
}  // namespace cscd
