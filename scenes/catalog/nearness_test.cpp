#include "scenes/catalog/nearness.h"

#include <cmath>
#include <gtest/gtest.h>
#include <random>

#include "core/base/error.h"
#include "core/mesh/test_shapes.h"
#include "scenes/catalog/triangle_distance.h"

namespace cscd::scenes {
namespace {

TriangleCorners corners_of(const test::Shape& shape, std::size_t triangle, const std::vector<Vec3>& x) {
  const Triangle& c = shape.triangles[triangle];
  return {x[+c[0]], x[+c[1]], x[+c[2]]};
}

// The definition of nearness, computed directly.
struct ByDefinition {
  const test::Shape& shape;
  double mean_edge = 0;
  std::vector<std::vector<double>> path;

  explicit ByDefinition(const test::Shape& of) : shape(of) {
    const std::size_t count = shape.positions.size();
    const TriangleMesh mesh = shape.mesh();
    path.assign(count, std::vector<double>(count, 1e300));
    for (std::size_t v = 0; v < count; ++v) path[v][v] = 0;
    for (const Edge& e : mesh.edges()) {
      const double length = (shape.positions[+e[0]] - shape.positions[+e[1]]).norm();
      path[+e[0]][+e[1]] = path[+e[1]][+e[0]] = length;
      mean_edge += length / static_cast<double>(mesh.edge_count());
    }
    for (std::size_t k = 0; k < count; ++k)
      for (std::size_t i = 0; i < count; ++i)
        for (std::size_t j = 0; j < count; ++j) path[i][j] = std::min(path[i][j], path[i][k] + path[k][j]);
  }
  bool apart(std::size_t s, std::size_t t) const {
    for (const VertexId v : shape.triangles[s])
      for (const VertexId w : shape.triangles[t])
        if (path[+v][+w] <= kApartOnSurface * mean_edge) return false;
    return true;
  }
  double closest(const std::vector<Vec3>& x) const {
    double least = 1e300;
    for (std::size_t s = 0; s < shape.triangles.size(); ++s)
      for (std::size_t t = s + 1; t < shape.triangles.size(); ++t)
        if (apart(s, t))
          least = std::min(least, triangle_distance(corners_of(shape, s, x), corners_of(shape, t, x)));
    return least / mean_edge;
  }
};

// Returns the positions of a tube whose axis is wound round a circle: `turns` turns from end to end,
// while the tube rises by `rise`.
std::vector<Vec3> wound(const test::Shape& tube, double length, double turns, double rise) {
  std::vector<Vec3> x;
  const double radius = length / (2 * std::numbers::pi * turns);
  for (const Vec3& p : tube.positions) {
    const double angle = p.x() / radius;
    x.emplace_back((radius + p.y()) * std::cos(angle), (radius + p.y()) * std::sin(angle),
                   p.z() + rise * p.x() / length);
  }
  return x;
}

TEST(Nearness, IsTheDefinition) {
  const test::Shape tube = test::capped_tube(6, 40, 0.3, 10);
  const ByDefinition definition(tube);
  const TriangleMesh mesh = tube.mesh();
  Nearness nearness(mesh, tube.positions);
  EXPECT_NEAR(nearness.mean_edge(), definition.mean_edge, 1e-12);
  EXPECT_FALSE(nearness.closest(tube.positions)) << "straight: nothing is near";
  int near = 0;
  for (const double turns : {0.5, 0.95, 1.0, 1.3, 1.7})
    for (const double rise : {0.2, 0.8, 1.5}) {
      const std::vector<Vec3> x = wound(tube, 10, turns, rise);
      const double expected = definition.closest(x);
      const auto found = nearness.closest(x);
      ASSERT_EQ(found.has_value(), expected < kFarthest) << turns << " turns, rising " << rise;
      if (!found) continue;
      ++near;
      EXPECT_NEAR(found->distance, expected, 1e-12) << turns << " turns, rising " << rise;
      EXPECT_TRUE(definition.apart(+found->a, +found->b));
      const double of_pair =
          triangle_distance(corners_of(tube, +found->a, x), corners_of(tube, +found->b, x)) /
          definition.mean_edge;
      EXPECT_NEAR(of_pair, expected, 1e-12);
    }
  EXPECT_GT(near, 5);
}

TEST(Nearness, DependsOnTheFrameAloneNotOnTheFramesBefore) {
  const test::Shape tube = test::capped_tube(6, 40, 0.3, 10);
  const TriangleMesh mesh = tube.mesh();
  Nearness used(mesh, tube.positions);
  for (const double turns : {1.3, 1.0, 0.5, 1.0, 1.7, 1.3}) {
    const std::vector<Vec3> x = wound(tube, 10, turns, 0.8);
    const auto fresh = Nearness(mesh, tube.positions).closest(x), warm = used.closest(x);
    ASSERT_EQ(fresh.has_value(), warm.has_value());
    if (!fresh) continue;
    EXPECT_EQ(fresh->a, warm->a);
    EXPECT_EQ(fresh->b, warm->b);
    EXPECT_EQ(fresh->distance, warm->distance);
  }
}

// A distance may round differently if the two triangles are exchanged. A bound from the last frame
// must not exclude its own pair.
TEST(Nearness, FindsThePairOfTheFrameBeforeAgain) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> near_middle(-1, 1);
  int found = 0;
  for (int i = 0; i < 500; ++i) {
    test::Shape two{{}, {test::corners(0, 1, 2), test::corners(3, 4, 5)}};
    for (int v = 0; v < 6; ++v)
      two.positions.emplace_back(near_middle(random) + (v < 3 ? 2 : 0), near_middle(random),
                                 near_middle(random));
    const TriangleMesh mesh = two.mesh();
    Nearness nearness(mesh, two.positions);
    const auto first = nearness.closest(two.positions), again = nearness.closest(two.positions);
    ASSERT_EQ(first.has_value(), again.has_value());
    if (!first) continue;
    ++found;
    EXPECT_EQ(first->distance, again->distance);
  }
  EXPECT_GT(found, 400);
}

// Spikes of four sides and seven rings on a plate, like those of the urchin.
TEST(Nearness, NeighbouringSpikesCountASpikesOwnSidesDoNot) {
  test::Shape both;
  for (const double x : {0.0, 0.5}) {
    test::Shape spike = test::uneven_tube(4, 7, 0.9, [](double h) { return 0.18 * (1 - h / 0.9) + 0.005; });
    for (Vec3& p : spike.positions) p = {p.y() + x, p.z(), p.x()};
    const TriangleMesh alone = spike.mesh();
    EXPECT_FALSE(Nearness(alone, spike.positions).closest(spike.positions));
    both = test::together(std::move(both), spike);
  }
  const int one = 4,
            other = 8 * 4 + 2 + 4;  // low vertices; a web of two triangles joins the spikes
  both.triangles.push_back(test::corners(one, other, other + 1));
  both.triangles.push_back(test::corners(one, other + 1, one + 1));
  const TriangleMesh mesh = both.mesh();
  ASSERT_EQ(mesh.component_count(), 1);
  Nearness nearness(mesh, both.positions);
  const auto at_rest = nearness.closest(both.positions);
  ASSERT_TRUE(!at_rest || at_rest->distance > kNear);
  std::vector<Vec3> x = both.positions;
  for (std::size_t v = 0; v < x.size(); ++v) {  // lean towards each other until the tips have passed
    const double lean = 0.3 * x[v].z() * x[v].z() / 0.81;
    x[v].x() += v < x.size() / 2 ? lean : -lean;
    x[v].y() += v < x.size() / 2 ? 0 : 0.06 * x[v].z();
  }
  const auto found = nearness.closest(x);
  ASSERT_TRUE(found);
  EXPECT_LT(found->distance, kNear);
}

TEST(Nearness, DifferentComponentsAreApart) {
  const test::Shape two = test::together(test::box(), test::box({1.5, 0, 0}, {2.5, 1, 1}));
  const TriangleMesh mesh = two.mesh();
  Nearness nearness(mesh, two.positions);
  const auto found = nearness.closest(two.positions);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->distance * nearness.mean_edge(), 0.5, 1e-12);
}

TEST(Nearness, HasNoMeasureOnAPoint) {
  const test::Shape point{{{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}, {test::corners(0, 1, 2)}};
  const TriangleMesh mesh = point.mesh();
  EXPECT_THROW(Nearness(mesh, point.positions), InputError);
}

}  // namespace
}  // namespace cscd::scenes
