#include <algorithm>
#include <gtest/gtest.h>
#include <numeric>
#include <random>

#include "core/base/test_refusal.h"
#include "core/mesh/test_shapes.h"
#include "library/test_steps.h"

namespace cscd {
namespace {

using namespace test;

// Mutation: the observers of the second cover are those of the first.
TEST(SelfCollision, AnswersTheSameFromASavedPreparation) {
  for (std::uint64_t seed = 1; seed <= intervals(); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const SceneStep step(seed);
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

// The mesh that was prepared lacked a tenth of the faces, had the others in another order, and its last
// vertex elsewhere. Mutation: what is taken over is cut again, too.
TEST(SelfCollision, AnswersRightFromThePreparationOfAMeshThatHasChangedSince) {
  std::size_t taken_over = 0;
  for (std::uint64_t seed = 1; seed <= intervals(); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const SceneStep step(seed);
    std::mt19937_64 random(seed);
    FaceRows earlier(step.faces.rows() - step.faces.rows() / 10, 3);
    std::vector<Eigen::Index> order(static_cast<std::size_t>(step.faces.rows()));
    std::iota(order.begin(), order.end(), Eigen::Index{0});
    std::ranges::shuffle(order, random);
    for (Eigen::Index f = 0; f < earlier.rows(); ++f)
      earlier.row(f) = step.faces.row(order[static_cast<std::size_t>(f)]);
    Rows at = step.start;
    at(at.rows() - 1, 0) += 1e-3;
    SelfCollision::Options options;
    options.preparation = SelfCollision(earlier, at).preparation();
    std::unique_ptr<SelfCollision> now;
    try {
      now = std::make_unique<SelfCollision>(step.faces, step.start, options);
    } catch (const std::invalid_argument& refused) {  // a mesh of few faces, most of them at that vertex
      EXPECT_NE(std::string(refused.what()).find("another surface"), std::string::npos) << refused.what();
      continue;
    }
    ++taken_over;
    expect_right(step, *now, Exclusions());
    if (testing::Test::HasFailure()) return;
  }
  EXPECT_GT(taken_over, intervals() / 2);
}

TEST(SelfCollision, RefusesThePreparationOfAnotherMesh) {
  const SceneStep step(1), other(2);
  SelfCollision::Options options;
  options.preparation = SelfCollision(step.faces, step.start).preparation();
  EXPECT_THROW(SelfCollision(other.faces, other.start, options), std::invalid_argument);
  options.preparation.pop_back();
  EXPECT_THROW(SelfCollision(step.faces, step.start, options), std::invalid_argument);
}

struct Tube {
  Shape shape = uneven_tube(12, 40, 15, [](double x) { return 0.8 + 0.1 * std::sin(3 * x); });
  FaceRows faces = face_rows(shape.triangles);
  Rows rest = rows(shape.positions);
};

// The trial takes the four parts of this tube. Mutation: labels are not handed on.
TEST(SelfCollision, CutsTheSurfaceAlongLabels) {
  const Tube tube;
  const double first = tube.rest.col(0).minCoeff(), last = tube.rest.col(0).maxCoeff();
  const auto prepared = [&](int parts) {
    SelfCollision::Options options;
    for (Eigen::Index v = 0; v < tube.rest.rows(); ++v)
      options.labels.push_back(-3 *
                               static_cast<int>((tube.rest(v, 0) - first) / (last - first) * parts * 0.999));
    return SelfCollision(tube.faces, tube.rest, options).preparation();
  };
  const std::vector<std::byte> of_surface = SelfCollision(tube.faces, tube.rest).preparation();
  EXPECT_NE(prepared(4), of_surface);
  EXPECT_EQ(prepared(1), of_surface) << "one label says nothing";
}

TEST(SelfCollision, AnswersTheSameWithLabels) {
  for (std::uint64_t seed = 1; seed <= intervals(); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const SceneStep step(seed);
    std::mt19937_64 random(seed);
    SelfCollision::Options labelled;
    for (Eigen::Index v = 0; v < step.start.rows(); ++v)
      labelled.labels.push_back(static_cast<int>(random() % (1 + seed % 5)) - 2);
    SelfCollision body(step.faces, step.start, labelled);
    expect_right(step, body, Exclusions());
    if (testing::Test::HasFailure()) return;
  }
}

TEST(SelfCollision, RefusesLabelsThatCannotBeParts) {
  const Tube tube;
  const auto refusal_of = [&](std::vector<int> labels) {
    SelfCollision::Options options;
    options.labels = std::move(labels);
    return refusal<std::invalid_argument>([&] { SelfCollision(tube.faces, tube.rest, options); });
  };
  const auto count = static_cast<std::size_t>(tube.rest.rows());
  EXPECT_EQ(refusal_of({1, 2}),
            "labels: 2 for " + std::to_string(count) + " vertices; give one label a vertex");
  const Shape fine = uneven_tube(12, 90, 15, [](double) { return 0.8; });
  SelfCollision::Options each;
  each.labels.resize(fine.positions.size());
  std::iota(each.labels.begin(), each.labels.end(), 0);
  EXPECT_THROW(SelfCollision(face_rows(fine.triangles), rows(fine.positions), each), std::invalid_argument);
}

}  // namespace
}  // namespace cscd
