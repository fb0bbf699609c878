#include "core/detect/start/pose_crossings.h"

#include <Eigen/Geometry>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <random>

#include "core/detect/test_feature_pairs.h"
#include "core/elementary/catalogue.h"
#include "core/mesh/test_shapes.h"

namespace cscd {
namespace {

constexpr std::size_t kAll = 1'000'000;

// One octahedron rests and another tumbles through it. Both are a little deformed at every step.
struct Tumbling {
  test::Shape shape = test::together(test::octahedron(), test::octahedron(0.8));
  TriangleMesh mesh = shape.mesh();
  std::mt19937 random{7};

  std::vector<Vec3> pose() {
    std::uniform_real_distribution<double> some(-1, 1);
    const Vec3 move = 1.1 * Vec3(some(random), some(random), some(random));
    const Eigen::AngleAxisd turn(3 * some(random),
                                 Vec3(some(random), some(random), some(random)).normalized());
    std::vector<Vec3> x = shape.positions;
    for (std::size_t v = 0; v < x.size(); ++v) {
      if (v >= 6) x[v] = turn * x[v] + move;
      x[v] += 0.1 * Vec3(some(random), some(random), some(random));
    }
    return x;
  }
};

TEST(PoseCrossings, FollowWhatTouchedOnTheWay) {
  const ElementaryTest& exact = *find_elementary_test("filtered_exact");
  Tumbling two;
  PoseCrossings followed({two.mesh, two.shape.positions}, kAll);
  EmbeddingTest from_nothing(two.mesh, two.shape.positions);
  std::vector<Vec3> from = two.pose();
  followed.find(from);
  std::size_t crossing = 0, changed = 0, free = 0;
  for (int step = 0; step < 60; ++step) {
    const std::vector<Vec3> to = two.pose();
    const ContactSet touched = test::contacts_by_asking(two.mesh, Motion(from, to), exact);
    const std::vector<CrossingPair> before = followed.crossings().pairs;
    const Crossings& got = followed.follow(to, touched);
    const Crossings expected = from_nothing.find_all(to, kAll);
    ASSERT_EQ(got.pairs, expected.pairs) << step;
    EXPECT_EQ(got.total, expected.total);
    crossing += !got.pairs.empty();
    changed += got.pairs != before;
    free += got.pairs.empty();
    from = to;
  }
  EXPECT_GT(crossing, 20u);
  EXPECT_GT(changed, 20u);
  EXPECT_GT(free, 3u) << "some poses must be embedded";
}

// The premise: if contacts are withheld, the crossings that follow from the rest are wrong.
TEST(PoseCrossings, NeedEverythingThatTouched) {
  Tumbling two;
  PoseCrossings followed({two.mesh, two.shape.positions}, kAll);
  EmbeddingTest from_nothing(two.mesh, two.shape.positions);
  std::size_t wrong = 0;
  for (int step = 0; step < 20; ++step) {
    followed.find(two.pose());
    const std::vector<Vec3> to = two.pose();
    wrong += followed.follow(to, {}).pairs != from_nothing.find_all(to, kAll).pairs;
  }
  EXPECT_GT(wrong, 5u);
}

TEST(PoseCrossings, KnowThePoseBitForBit) {
  const test::Shape shape = test::octahedron();
  const TriangleMesh mesh = shape.mesh();
  PoseCrossings crossings({mesh, shape.positions}, kAll);
  EXPECT_FALSE(crossings.knows(shape.positions));
  crossings.find(shape.positions);
  EXPECT_TRUE(crossings.knows(shape.positions));
  std::vector<Vec3> other = shape.positions;
  other[5].x() = std::nextafter(other[5].x(), 9.0);
  EXPECT_FALSE(crossings.knows(other));
}

// If not all pairs were kept, the crossings are found from nothing.
TEST(PoseCrossings, FindFromNothingWhatTheyCannotDerive) {
  const test::Shape shape = test::together(test::octahedron(), test::octahedron());
  const TriangleMesh mesh = shape.mesh();
  PoseCrossings crossings({mesh, shape.positions}, 3);
  const std::size_t total = crossings.find(shape.positions).total;
  EXPECT_GT(total, 3u);
  EXPECT_EQ(crossings.crossings().pairs.size(), 3u);
  EXPECT_FALSE(crossings.crossings().all_kept());
  EXPECT_EQ(crossings.follow(shape.positions, {}).total, total);
}

TEST(Crossings, AreCarriedByTheTrianglesOfBothFeatures) {
  const test::Shape shape = test::together(test::octahedron(), test::octahedron(0.5));
  const TriangleMesh mesh = shape.mesh();
  const FeaturePair pair = FeaturePair::of(VertexId{0}, TriangleId{12});
  const std::vector<CrossingPair> both = carriers(mesh, pair);
  ASSERT_EQ(both.size(), 4u);
  for (const CrossingPair& p : both) EXPECT_EQ(p.second, TriangleId{12});
  EXPECT_EQ(carriers(mesh, FeaturePair::of(EdgeId{0}, EdgeId{13})).size(), 4u);
}

// Mutations: a difference behind the first block is passed over; what was written over is not put back;
// only the last number counts as not finite.
TEST(PoseCrossings, MoveOnFromTheLastKnownPoseAlone) {
  const test::Shape shape = test::icosphere(3);
  const TriangleMesh mesh = shape.mesh();
  PoseCrossings crossings({mesh, shape.positions}, kAll);
  std::vector<Vec3> end = shape.positions;
  for (Vec3& p : end) p *= 1.5;
  bool finite = false;
  EXPECT_FALSE(crossings.move_on(shape.positions, end, finite)) << "nothing is known yet";
  crossings.find(shape.positions);
  for (const std::size_t v : {std::size_t{0}, shape.positions.size() / 2, shape.positions.size() - 1}) {
    std::vector<Vec3> start = shape.positions;
    start[v].z() = -start[v].z();
    start[v].x() += 1e-12;
    EXPECT_FALSE(crossings.move_on(start, end, finite)) << v;
    EXPECT_TRUE(crossings.knows(shape.positions)) << v;
    for (const double wrong : {std::numeric_limits<double>::infinity(), std::nan("")}) {
      std::vector<Vec3> nowhere = end;
      nowhere[v].y() = wrong;
      EXPECT_TRUE(crossings.move_on(shape.positions, nowhere, finite));
      EXPECT_FALSE(finite) << v;
      crossings.go_back(shape.positions);
      EXPECT_TRUE(crossings.knows(shape.positions));
    }
  }
  end[7].y() = -std::numeric_limits<double>::max();
  EXPECT_TRUE(crossings.move_on(shape.positions, end, finite));
  EXPECT_TRUE(finite);
  EXPECT_TRUE(crossings.knows(end));
  EXPECT_FALSE(crossings.return_to(shape.positions)) << "nothing is kept unless asked for";
  EXPECT_TRUE(crossings.move_on(end, shape.positions, finite));
  crossings.keep_before();
  EXPECT_TRUE(crossings.move_on(shape.positions, end, finite));
  EXPECT_FALSE(crossings.return_to(end)) << "that is no return";
  EXPECT_TRUE(crossings.return_to(shape.positions));
  EXPECT_TRUE(crossings.return_to(end)) << "and there again";
  crossings.go_back(shape.positions);
  EXPECT_TRUE(crossings.knows(shape.positions));
  EXPECT_FALSE(crossings.return_to(end)) << "something may have touched on the way there";
}

}  // namespace
}  // namespace cscd
