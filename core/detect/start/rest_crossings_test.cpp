#include "core/detect/start/rest_crossings.h"

#include <cmath>
#include <gtest/gtest.h>

#include "core/detect/start/embedding.h"
#include "core/elementary/exact/static_contact.h"
#include "core/mesh/test_shapes.h"

namespace cscd {
namespace {

constexpr std::size_t kAllPairs = 1'000'000;

// A small ball looks out of a larger one, as an eye does.
struct Eye {
  test::Shape shape = test::together(test::icosphere(3), test::moved(test::icosphere(2), {0.9, 0, 0}, 0.3));
  TriangleMesh mesh = shape.mesh();
  EmbeddingTest test{mesh, shape.positions};

  // Returns the positions with the small ball moved by `by` and the large one where it is.
  std::vector<Vec3> moved(const Vec3& by) const {
    std::vector<Vec3> x = shape.positions;
    for (std::size_t v = test::icosphere(3).positions.size(); v < x.size(); ++v) x[v] += by;
    return x;
  }
  std::size_t unexplained(const RestCrossings& rest, const std::vector<Vec3>& positions) {
    std::size_t count = 0;
    for (const CrossingPair& pair : test.find_all(positions, kAllPairs).pairs) count += !rest.explains(pair);
    return count;
  }
};

TEST(RestCrossings, ExplainThemselvesAndWhereTheyShiftTo) {
  Eye eye;
  const Crossings at_rest = eye.test.find_all(eye.shape.positions, kAllPairs);
  ASSERT_GT(at_rest.total, 20u);
  const RestCrossings rest(eye.mesh, at_rest);
  EXPECT_EQ(eye.unexplained(rest, eye.shape.positions), 0u);
  EXPECT_EQ(eye.unexplained(rest, eye.moved({0.02, 0.01, 0})), 0u);
  EXPECT_NE(eye.test.find_all(eye.moved({0.02, 0.01, 0}), kAllPairs).pairs, at_rest.pairs)
      << "the line must shift";
  EXPECT_GT(eye.unexplained(rest, eye.moved({-1.8, 0, 0})), 20u) << "out at the back of the head";
  EXPECT_GT(eye.unexplained(RestCrossings(), eye.shape.positions), 20u);
}

TEST(RestCrossings, ExplainFeaturePairsOfTheirTriangles) {
  Eye eye;
  const Crossings at_rest = eye.test.find_all(eye.shape.positions, kAllPairs);
  const RestCrossings rest(eye.mesh, at_rest);
  const auto [head, ball] = at_rest.pairs.front();
  EXPECT_TRUE(rest.explains(FeaturePair::of(eye.mesh.corners(head)[0], ball)));
  EXPECT_TRUE(rest.explains(FeaturePair::of(eye.mesh.edges_of(head)[1], eye.mesh.edges_of(ball)[2])));
  EXPECT_FALSE(rest.explains(FeaturePair::of(eye.mesh.corners(head)[0], TriangleId{0})))
      << "two places of the head itself";
  EXPECT_FALSE(RestCrossings().explains(FeaturePair::of(eye.mesh.corners(head)[0], ball)));
}

// A surface of one component crosses itself. Triangle pairs beside the crossing ones are not explained.
TEST(RestCrossings, InsideOneComponentExplainThePairsAlone) {
  test::Shape shape = test::icosphere(2);
  shape.positions[0] = -1.05 * shape.positions[0];
  const TriangleMesh mesh = shape.mesh();
  const Crossings at_rest = EmbeddingTest(mesh, shape.positions).find_all(shape.positions, kAllPairs);
  ASSERT_GT(at_rest.total, 1u);
  const RestCrossings rest(mesh, at_rest);
  std::size_t neighbours = 0, explained = 0;
  for (const CrossingPair& pair : at_rest.pairs) {
    EXPECT_TRUE(rest.explains(pair));
    for (const VertexId v : mesh.corners(pair.second))
      for (const TriangleId t : mesh.triangles_at(v)) {
        const CrossingPair near(std::min(pair.first, t), std::max(pair.first, t));
        if (t == pair.first || at_rest.contains(near)) continue;
        ++neighbours;
        explained += rest.explains(near);
      }
  }
  EXPECT_GT(neighbours, 5u);
  EXPECT_EQ(explained, 0u);
}

// The eye leaves its socket and comes back. Mutations: follow() forgets nothing; it takes the shifted line of
// a crossing for a parting.
TEST(RestCrossings, ExplainNothingThatHasPartedInTheMeantime) {
  Eye eye;
  const Crossings at_rest = eye.test.find_all(eye.shape.positions, kAllPairs);
  RestCrossings rest(eye.mesh, at_rest);
  const std::vector<Vec3> shifted = eye.moved({0.02, 0.01, 0}), apart = eye.moved({2, 0, 0});
  for (int turn = 0; turn < 3; ++turn)
    for (const std::vector<Vec3>& pose : {shifted, eye.shape.positions}) {
      rest.follow(eye.test.find_all(pose, kAllPairs));
      ASSERT_EQ(eye.unexplained(rest, pose), 0u) << turn;
    }
  Crossings unknown = eye.test.find_all(apart, kAllPairs);
  unknown.total = 1;  // none of which is kept
  rest.follow(unknown);
  EXPECT_EQ(eye.unexplained(rest, shifted), 0u) << "nothing is known to have parted";
  rest.follow(eye.test.find_all(apart, kAllPairs));
  EXPECT_EQ(eye.unexplained(rest, eye.shape.positions), at_rest.total);
}

// One half of what crosses parts: the other half goes on being explained.
TEST(RestCrossings, PartPlaceByPlace) {
  const test::Shape head = test::icosphere(3), ball = test::moved(test::icosphere(2), {0.9, 0, 0}, 0.3);
  const test::Shape face = test::together(test::together(head, ball), test::moved(ball, {-1.8, 0, 0}));
  const TriangleMesh mesh = face.mesh();
  EmbeddingTest test(mesh, face.positions);
  RestCrossings rest(mesh, test.find_all(face.positions, kAllPairs));
  std::vector<Vec3> one_out = face.positions;
  for (std::size_t v = head.positions.size() + ball.positions.size(); v < one_out.size(); ++v)
    one_out[v] -= Vec3(1, 0, 0);
  rest.follow(test.find_all(one_out, kAllPairs));
  const Crossings again = test.find_all(face.positions, kAllPairs);
  std::size_t explained = 0;
  for (const CrossingPair& pair : again.pairs) explained += rest.explains(pair);
  EXPECT_EQ(explained, test.find_all(one_out, kAllPairs).total);
  EXPECT_LT(explained, again.total);
}

// A box on a box, an eye in a socket: told apart pair by pair.
TEST(Meetings, AreToldApartByWhetherTrianglesPassThroughEachOther) {
  const test::Shape ball = test::octahedron();
  // Two octahedra of radius 1 share one corner's place, then overlap by half of it.
  for (const double distance : {2.0, 1.5}) {
    const test::Shape both = test::together(ball, test::moved(ball, {distance, 0, 0}));
    const TriangleMesh mesh = both.mesh();
    const Crossings met = EmbeddingTest(mesh, both.positions).find_all(both.positions, kAllPairs);
    ASSERT_GT(met.total, 0u) << distance;
    const Meetings kinds = tell_meetings_apart(mesh, both.positions, met);
    EXPECT_EQ(kinds.crossing.total + kinds.touching.total, met.total);
    EXPECT_EQ(kinds.crossing.total > 0, distance < 2) << distance;
    EXPECT_TRUE(kinds.crossing.all_kept() && kinds.touching.all_kept());
  }
}

// Of two equal boxes that are shifted along an axis, no two triangles need pass through each other. Boxes
// that stand side by side only touch, and so does what has no inside. Mutations: the facing is not looked at;
// open surfaces count as closed.
TEST(Meetings, FlushWallsOfClosedSurfacesCross) {
  const test::Shape box = test::box();
  for (int axis = 0; axis < 3; ++axis)
    for (const double shift : {-1.0, -0.5, 0.25, 0.5, 0.75, 1.0}) {
      const test::Shape both = test::together(box, test::moved(box, shift * Vec3::Unit(axis)));
      const auto told = [&](const test::Shape& shape) {
        const TriangleMesh mesh = shape.mesh();
        const Crossings met = EmbeddingTest(mesh, shape.positions).find_all(shape.positions, kAllPairs);
        return tell_meetings_apart(mesh, shape.positions, met);
      };
      const Meetings kinds = told(both);
      EXPECT_EQ(kinds.crossing.total > 0, std::abs(shift) < 1) << axis << " " << shift;
      EXPECT_GT(kinds.touching.total, 0u) << axis << " " << shift;
      test::Shape open = both;
      open.triangles.pop_back();
      const TriangleMesh mesh = open.mesh();
      for (const CrossingPair& pair : told(open).crossing.pairs)
        EXPECT_TRUE(triangles_cross(mesh, open.positions, pair.first, pair.second)) << axis << " " << shift;
    }
}

}  // namespace
}  // namespace cscd
