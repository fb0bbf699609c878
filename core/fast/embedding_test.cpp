#include <Eigen/Geometry>
#include <gtest/gtest.h>
#include <limits>
#include <numbers>
#include <random>

#include "core/elementary/catalogue.h"
#include "core/fast/clusters/surface_clusters.h"
#include "core/fast/drvbc_fast.h"
#include "core/fast/fast_culler.h"
#include "core/mesh/test_shapes.h"

namespace cscd {
namespace {

using test::Shape;

constexpr std::size_t kAll = std::numeric_limits<std::size_t>::max();

StrategyInput setup_of(const TriangleMesh& mesh, std::span<const Vec3> reference, int threads = 1) {
  return {mesh, reference, nullptr, *find_elementary_test("filtered_exact"), threads};
}

// A test of the start that culls as `drvbc_fast` does, by signs alone.
EmbeddingTest by_signs(const TriangleMesh& mesh, std::span<const Vec3> reference) {
  return {mesh, std::make_unique<fast::FastCuller>(
                    setup_of(mesh, reference),
                    fast::cut_surface(mesh, reference, fast::surface_clusters(mesh, reference)),
                    DrvbcFastOptions{})};
}

// Shapes whose poses are compared. They are closed but for the last one.
std::vector<Shape> shapes() {
  const auto radius = [](double x) { return 0.5 + 0.1 * std::sin(2 * x); };
  return {test::icosphere(2),
          test::torus(),
          test::uneven_tube(8, 60, 12, radius),
          test::uneven_tube(12, 120, 40, radius),
          test::together(test::icosphere(1), test::moved(test::icosphere(2), {2.2, 0.1, 0.2})),
          test::together(test::octahedron(), test::octahedron(0.5)),
          test::ramp(24, 1.25, 1, 2, 1)};
}

// Throws a pose: winds the x axis into part of a circle or several turns of one, and shakes all vertices.
std::vector<Vec3> thrown(const Shape& shape, std::mt19937& random) {
  const auto dice = [&] { return static_cast<double>(random() >> 8) * 0x1p-23 - 1; };
  Eigen::AlignedBox3d box;
  for (const Vec3& p : shape.positions) box.extend(p);
  const double length = box.sizes().x(), angle = 2.5 * std::numbers::pi * (1 + dice());
  const double noise = 0.05 * std::pow(0.5 * (1 + dice()), 3), pitch = 0.5 * dice();
  std::vector<Vec3> pose;
  for (const Vec3& p : shape.positions) {
    const double at = angle * (p.x() - box.min().x()) / length, r = length / angle + p.y();
    pose.emplace_back(r * std::sin(at), r * std::cos(at), p.z() + pitch * at);
    pose.back() += noise * Vec3(dice(), dice(), dice());
  }
  return pose;
}

// The pairs that the fast test finds are those of the plain test, on any pose of any surface. Mutations that
// die here: the ray is not counted; what is clear in one pose counts as clear in the next.
TEST(FastEmbedding, SaysOfEveryPoseWhatThePlainTestSays) {
  std::size_t embedded = 0, crossing = 0;
  for (const Shape& shape : shapes()) {
    const TriangleMesh mesh = shape.mesh();
    EmbeddingTest plain(mesh, shape.positions),
        fast = make_embedding_test(setup_of(mesh, shape.positions)),
        shared = make_embedding_test(setup_of(mesh, shape.positions, 2));
    std::mt19937 random(5);
    for (int i = 0; i < 60; ++i) {
      const std::vector<Vec3> pose = thrown(shape, random);
      const Crossings expected = plain.find_all(pose, kAll);
      ASSERT_EQ(fast.find_all(pose, kAll).pairs, expected.pairs) << i;
      ASSERT_EQ(shared.find_all(pose, kAll).pairs, expected.pairs) << i;
      EXPECT_EQ(fast.embedded(pose), expected.total == 0) << i;
      ++(expected.total == 0 ? embedded : crossing);
    }
  }
  EXPECT_GT(embedded, 80u);
  EXPECT_GT(crossing, 80u);
}

// What crosses at a start is found along the way of a query, whatever happens after the start. Mutations that
// die here: the pairs at the end of the interval are tested; pairs that the filter dropped are left out.
TEST(FastEmbedding, AQuerySeesAtItsStartWhatThePlainTestSees) {
  std::size_t seen = 0;
  for (const Shape& shape : shapes()) {
    const TriangleMesh mesh = shape.mesh();
    EmbeddingTest plain(mesh, shape.positions);
    const std::unique_ptr<Detector> complete =
        make_drvbc_fast(setup_of(mesh, shape.positions), {.name = "complete", .complete = true}).detector;
    std::mt19937 random(5);
    ContactSet found, alone;
    Crossings start;
    for (int i = 0; i < 20; ++i) {
      const std::vector<Vec3> from = thrown(shape, random), toward = thrown(shape, random);
      std::vector<Vec3> to = from;  // a long step would spend the time on contacts
      for (std::size_t v = 0; v < to.size(); ++v) to[v] += 0.01 * (toward[v] - from[v]);
      const Motion motion(from, to);
      complete->detect({.motion = motion, .crossings = &start, .most_crossings = kAll}, found);
      ASSERT_EQ(start.pairs, plain.find_all(from, kAll).pairs) << i;
      EXPECT_EQ(start.total, start.pairs.size());
      seen += start.total;
      complete->detect({motion}, alone);
      found.sort(), alone.sort();
      EXPECT_EQ(digest(found), digest(alone)) << i;
    }
  }
  EXPECT_GT(seen, 500u);
}

// Why the start needs more than signs: pairs of triangles that cross, though both lie in one cluster and have
// one sign.
TEST(FastEmbedding, SignsAloneLoseCrossings) {
  std::size_t lost = 0;
  for (const Shape& shape : shapes()) {
    const TriangleMesh mesh = shape.mesh();
    if (!mesh.closed_and_oriented()) continue;
    EmbeddingTest plain(mesh, shape.positions), signs = by_signs(mesh, shape.positions);
    std::mt19937 random(5);
    for (int i = 0; i < 60; ++i) {
      const std::vector<Vec3> pose = thrown(shape, random);
      const Crossings expected = plain.find_all(pose, kAll), found = signs.find_all(pose, kAll);
      lost += expected.total - found.total;
    }
  }
  EXPECT_GT(lost, 100u);
}

TEST(FastEmbedding, FindsAFaceThatIsPiercedThoughNoFeaturePairTouches) {
  // The tip of a long spike of one sphere stands in the middle of a face of another sphere.
  Shape shape = test::together(test::icosphere(2), test::moved(test::icosphere(2), {4, 0, 0}));
  const TriangleMesh mesh = shape.mesh();
  EmbeddingTest fast = make_embedding_test(setup_of(mesh, shape.positions));
  EXPECT_TRUE(fast.embedded(shape.positions));
  const auto second = static_cast<std::size_t>(shape.positions.size() / 2);
  const auto tip = std::ranges::min_element(shape.positions.begin() + static_cast<std::ptrdiff_t>(second),
                                            shape.positions.end(), {}, [](const Vec3& p) { return p.x(); });
  const Triangle& face = mesh.triangles()[7];
  const Vec3 middle = (shape.positions[+face[0]] + shape.positions[+face[1]] + shape.positions[+face[2]]) / 3;
  *tip = 0.9 * middle;
  EXPECT_FALSE(fast.embedded(shape.positions));
  EmbeddingTest plain(mesh, shape.positions);
  EXPECT_EQ(fast.find_all(shape.positions, kAll).pairs, plain.find_all(shape.positions, kAll).pairs);
}

// Poses in which nothing has an extent. The first pair that is found ends the search.
TEST(FastEmbedding, TakesPosesThatHaveCollapsed) {
  const Shape shape = test::icosphere(1);
  const TriangleMesh mesh = shape.mesh();
  EmbeddingTest plain(mesh, shape.positions), fast = make_embedding_test(setup_of(mesh, shape.positions));
  const std::vector<Vec3> point(shape.positions.size(), Vec3(1, 2, 3));
  std::vector<Vec3> flat = shape.positions, line = shape.positions, huge = shape.positions;
  for (Vec3& p : flat) p.z() = 0;
  for (Vec3& p : line) p.y() = p.z() = 0;
  for (Vec3& p : huge) p *= 1e300;
  for (const std::vector<Vec3>& pose : {point, flat, line, huge}) {
    EXPECT_EQ(fast.find_all(pose, kAll).pairs, plain.find_all(pose, kAll).pairs);
    EXPECT_EQ(fast.embedded(pose), plain.embedded(pose));
    if (!fast.embedded(pose)) {
      EXPECT_LE(fast.pairs_tested(), 64u);
    }
  }
}

}  // namespace
}  // namespace cscd
