#include "baselines/mcd/mcd.h"

#include <gmpxx.h>
#include <gtest/gtest.h>
#include <random>

#include "baselines/mcd/contour.h"
#include "baselines/mcd/discs.h"
#include "baselines/mcd/normal_cones.h"
#include "baselines/plain.h"
#include "core/elementary/catalogue.h"
#include "core/mesh/test_shapes.h"
#include "core/radial/test_exact_orientation.h"

namespace cscd::mcd {
namespace {

using test::corners;
using test::Shape;

double uniform(std::mt19937_64& random, double low, double high) {
  return low + (high - low) * static_cast<double>(random() >> 11) * 0x1p-53;
}

std::vector<Vec3> shaken(std::vector<Vec3> positions, double by, std::mt19937_64& random) {
  for (Vec3& p : positions)
    for (int k = 0; k < 3; ++k) p[k] += uniform(random, -by, by);
  return positions;
}

using test::Exact3;

Exact3 exact_normal(const Motion& motion, const Triangle& corner, const mpq_class& t) {
  using test::operator-;
  const Exact3 a = test::at(motion[corner[0]], t);
  return test::cross(test::at(motion[corner[1]], t) - a, test::at(motion[corner[2]], t) - a);
}

// Returns whether the normal is inside the cone, decided in rational arithmetic.
bool inside(const Exact3& n, const NormalCone& cone) {
  const Exact3 axis = test::exact(cone.axis);
  const mpq_class along = test::dot(n, axis), cosine = cone.cosine;
  return along > 0 && along * along >= cosine * cosine * test::dot(n, n) * test::dot(axis, axis);
}

TEST(NormalCones, HoldEveryNormalBelowThemAtAllTimes) {
  std::mt19937_64 random(1);
  std::size_t known = 0, wide = 0;
  for (int round = 0; round < 12; ++round) {
    const Shape shape = test::icosphere(1, std::pow(10.0, round - 6));
    const TriangleMesh mesh = shape.mesh();
    const Tree tree = build_tree(mesh, shape.positions);
    NormalCones cones(mesh, tree);
    const double scale = shape.positions[0].norm();
    const std::vector<Vec3> start = shaken(shape.positions, 0.1 * scale, random);
    const std::vector<Vec3> end = shaken(start, 0.02 * (round % 6) * scale, random);
    const Motion motion(start, end);
    cones.update(tree, motion);
    for (NodeIndex node = 0; node < static_cast<NodeIndex>(tree.node_count()); ++node) {
      if (!cones[node].in_half_space()) continue;
      ++known;
      wide += cones[node].cosine < 0.5;
      NodeIndex last = node;
      while (!tree.is_leaf(last)) last = tree.right(last);
      for (NodeIndex leaf = node; leaf <= last; ++leaf) {
        if (!tree.is_leaf(leaf)) continue;
        for (int i = 0; i <= 4; ++i)
          ASSERT_TRUE(
              inside(exact_normal(motion, mesh.corners(tree.triangle(leaf)), mpq_class(i, 4)), cones[node]))
              << "round " << round << ", node " << node << ", leaf " << leaf << ", t = " << i << "/4";
      }
    }
  }
  EXPECT_GT(known, 1000u);
  EXPECT_GT(wide, 30u) << "all cones are narrow";
}

// Mutation: scalar code takes the corners of a triangle in another order.
TEST(NormalCones, AreTheSameOneByOne) {
  std::mt19937_64 random(2);
  const Shape shape = test::icosphere(2);
  const TriangleMesh mesh = shape.mesh();
  const Tree tree = build_tree(mesh, shape.positions);
  NormalCones in_lanes(mesh, tree), one_by_one(mesh, tree, Pipeline::published);
  for (int round = 0; round < 5; ++round) {
    const std::vector<Vec3> start = shaken(shape.positions, 0.1, random), end = shaken(start, 0.1, random);
    in_lanes.update(tree, Motion(start, end));
    one_by_one.update(tree, Motion(start, end));
    for (NodeIndex node = 0; node < static_cast<NodeIndex>(tree.node_count()); ++node) {
      ASSERT_EQ(in_lanes[node].axis, one_by_one[node].axis);
      ASSERT_EQ(in_lanes[node].cosine, one_by_one[node].cosine);
    }
  }
}

TEST(NormalCones, AreUnknownWhereTheNormalVanishesOrTurnsRound) {
  const auto cone_of = [](const std::vector<Vec3>& start, const std::vector<Vec3>& end) {
    const TriangleMesh mesh({corners(0, 1, 2)}, 3);
    const Tree tree = build_tree(mesh, start);
    NormalCones cones(mesh, tree);
    cones.update(tree, Motion(start, end));
    return cones[0];
  };
  const std::vector<Vec3> flat = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  EXPECT_TRUE(cone_of(flat, flat).in_half_space());
  EXPECT_FALSE(cone_of(flat, {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}).in_half_space()) << "ends as a line";
  EXPECT_FALSE(cone_of(flat, {{0, 0, 0}, {1, 0, 0}, {0, -1, 0}}).in_half_space()) << "turns over";
  EXPECT_FALSE(cone_of({{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}, flat).in_half_space()) << "starts as a point";
  EXPECT_FALSE(cone_of({{0, 0, 0}, {1e200, 0, 0}, {0, 1e200, 0}}, flat).in_half_space()) << "overflows";
}

TEST(NormalCones, DegenerateTrianglesHaveNone) {
  Shape shape = test::icosphere(1);
  const TriangleMesh mesh = shape.mesh();
  const Tree tree = build_tree(mesh, shape.positions);
  const Triangle& flat = mesh.triangles()[17];
  shape.positions[+flat[0]] = shape.positions[+flat[1]];
  NormalCones cones(mesh, tree);
  cones.update(tree, Motion(shape.positions, shape.positions));
  std::size_t spoilt = 0;
  for (NodeIndex node = 0; node < static_cast<NodeIndex>(tree.node_count()); ++node) {
    if (!tree.is_leaf(node)) continue;
    spoilt += !cones[node].in_half_space();
    if (mesh.corners(tree.triangle(node)) == flat) {
      EXPECT_FALSE(cones[node].in_half_space());
    }
  }
  EXPECT_EQ(spoilt, 2u) << "the two triangles at the edge that shrank to a point";
}

// Returns the contour of the whole mesh as one node.
std::vector<VertexId> contour_of_all(const std::vector<Triangle>& triangles, std::size_t vertices) {
  const TriangleMesh mesh(triangles, vertices);
  const std::vector<Vec3> positions(vertices, Vec3(0, 0, 0));
  const Tree tree = build_tree(mesh, positions);
  const Discs discs(mesh, tree);
  return {discs.contour(0).begin(), discs.contour(0).end()};
}

TEST(Discs, AreFoundByCountsAlone) {
  const Shape ramp = test::ramp(24, 2.25, 1, 2, 1);
  EXPECT_EQ(contour_of_all(ramp.triangles, ramp.positions.size()).size(), 2 * 24u + 2 + 2);
  const std::vector<VertexId> square = contour_of_all({corners(0, 1, 2), corners(0, 2, 3)}, 4);
  ASSERT_EQ(square.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_EQ((static_cast<int>(square[i]) + 1) % 4, static_cast<int>(square[(i + 1) % 4]))
        << "runs backwards";
  // A vertex in the interior is not on the contour.
  EXPECT_EQ(contour_of_all({corners(0, 1, 3), corners(1, 2, 3), corners(2, 0, 3)}, 4).size(), 3u);
}

TEST(Discs, AreNot) {
  const auto none = [](const std::vector<Triangle>& triangles, std::size_t vertices) {
    return contour_of_all(triangles, vertices).empty();
  };
  const Shape ball = test::icosphere(1);
  EXPECT_TRUE(none(ball.triangles, ball.positions.size())) << "closed";
  EXPECT_TRUE(none({corners(0, 1, 2), corners(3, 4, 5)}, 6)) << "two pieces";
  EXPECT_TRUE(none({corners(0, 1, 2), corners(0, 3, 4)}, 5)) << "held together by a vertex";
  EXPECT_TRUE(none({corners(0, 1, 2), corners(1, 2, 3)}, 4)) << "oriented against each other";
  EXPECT_TRUE(none({corners(0, 1, 2), corners(1, 0, 3), corners(0, 1, 4)}, 5)) << "three at an edge";
  EXPECT_TRUE(none({corners(0, 1, 3), corners(1, 4, 3), corners(1, 2, 4), corners(2, 5, 4), corners(2, 0, 5),
                    corners(0, 3, 5)},
                   6))
      << "a ring";
  std::vector<Triangle> holed = test::icosphere(1).triangles;
  holed.pop_back();
  EXPECT_FALSE(none(holed, ball.positions.size())) << "a ball with one hole is a disc";
  holed.erase(holed.begin());
  EXPECT_TRUE(none(holed, ball.positions.size())) << "with two it is a ring";
}

// Two leaves with a common edge form a square, and other pairs of leaves have no contour. Many pairs of
// larger nodes have longer contours.
TEST(Discs, OfTwoNeighboursHaveOneContour) {
  const Shape shape = test::torus();
  const TriangleMesh mesh = shape.mesh();
  const Tree tree = build_tree(mesh, shape.positions);
  const Discs discs(mesh, tree);
  const auto nodes = static_cast<NodeIndex>(tree.node_count());
  std::size_t squares = 0, larger = 0;
  for (NodeIndex a = 0; a < nodes; ++a)
    for (NodeIndex b = a + 1; b < nodes; ++b) {
      const std::span<const VertexId> contour = discs.contour(a, b);
      const bool leaves = tree.is_leaf(a) && tree.is_leaf(b);
      if (leaves) {
        const auto one = mesh.edges_of(tree.triangle(a)), other = mesh.edges_of(tree.triangle(b));
        const bool common = std::any_of(one.begin(), one.end(), [&](EdgeId e) {
          return std::find(other.begin(), other.end(), e) != other.end();
        });
        ASSERT_EQ(contour.size(), common ? 4u : 0u);
        squares += common;
      }
      larger += contour.size() > 4;
    }
  EXPECT_EQ(squares, mesh.edge_count());
  EXPECT_GT(larger, 100u);
}

bool simple(const std::vector<Vec3>& start, const std::vector<Vec3>& end, const Vec3& direction = {0, 0, 1}) {
  std::vector<VertexId> loop;
  for (std::size_t i = 0; i < start.size(); ++i) loop.push_back(VertexId{static_cast<std::int32_t>(i)});
  return ContourTest().simple(loop, direction, Motion(start, end));
}

std::vector<Vec3> moved(std::vector<Vec3> positions, const Vec3& by) {
  for (Vec3& p : positions) p += by;
  return positions;
}

TEST(ContourTest, TellsSimpleCurvesFromOthers) {
  const std::vector<Vec3> square = {{0, 0, 0}, {2, 0, 1}, {2, 2, 0}, {0, 2, 1}};
  EXPECT_TRUE(simple(square, square));
  EXPECT_TRUE(simple(square, moved(square, {100, -50, 70}))) << "motion in common is none";
  EXPECT_TRUE(simple(square, moved(square, {100, -50, 70}), {0.3, -0.2, 0.9}));
  std::vector<Vec3> turned = square;
  for (Vec3& p : turned) p = Vec3(0.8 * p.x() - 0.6 * p.y(), 0.6 * p.x() + 0.8 * p.y(), p.z());
  EXPECT_TRUE(simple(square, turned));

  EXPECT_FALSE(simple({{0, 0, 0}, {2, 2, 0}, {2, 0, 0}, {0, 2, 0}}, square)) << "starts crossed";
  EXPECT_FALSE(simple(square, {{0, 0, 0}, {2, 2, 0}, {2, 0, 0}, {0, 2, 0}})) << "ends crossed";
  EXPECT_FALSE(simple(square, square, {1, 0, 0})) << "seen from the side";
  const std::vector<Vec3> spike = {{0, 0, 0}, {2, 0, 0}, {4, 0, 0}, {3, 0, 0}, {2, 3, 0}};
  EXPECT_FALSE(simple(spike, spike)) << "two neighbours lie on each other";
  const std::vector<Vec3> flat_corner = {{0, 0, 0}, {2, 0, 0}, {4, 0, 0}, {2, 3, 0}};
  EXPECT_TRUE(simple(flat_corner, flat_corner)) << "two neighbours in one line are none";
  const std::vector<Vec3> touching = {{0, 0, 0}, {4, 0, 0}, {4, 2, 0}, {2, 0, 0}, {0, 2, 0}};
  EXPECT_FALSE(simple(touching, touching)) << "a corner lies on an edge";
}

TEST(ContourTest, LooksBetweenTheEnds) {
  const std::vector<Vec3> notched = {{0, 0, 0}, {6, 0, 0}, {6, 1, 0}, {3, 0.5, 0}, {0, 1, 0}};
  std::vector<Vec3> beyond = notched;
  beyond[3] = {9, 0.5, 0};
  EXPECT_TRUE(simple(notched, notched));
  EXPECT_FALSE(simple(notched, beyond)) << "the notch goes through an edge";
  const std::vector<Vec3> lens = {{-4, 0, 0}, {0, -1, 0}, {4, 0, 0}, {0, 1, 0}};
  std::vector<Vec3> turned_over = lens;
  std::swap(turned_over[1], turned_over[3]);
  EXPECT_TRUE(simple(turned_over, turned_over));
  EXPECT_FALSE(simple(lens, turned_over)) << "simple at both ends, a line in the middle";
}

// Loops around a circle move far without changing shape and are seen from several directions.
// Then one vertex is pulled across.
TEST(ContourTest, OfLongLoopsIsQuickAndRight) {
  std::mt19937_64 random(5);
  for (const int count : {3, 4, 5, 17, 64, 301}) {
    std::vector<Vec3> loop;
    for (int i = 0; i < count; ++i) {
      const double angle = 2 * std::numbers::pi * i / count;
      loop.emplace_back(std::cos(angle), std::sin(angle), uniform(random, -0.1, 0.1));
    }
    const Vec3 direction(uniform(random, -0.3, 0.3), uniform(random, -0.3, 0.3), 1);
    EXPECT_TRUE(simple(loop, moved(loop, {3, 4, 5}), direction)) << count;
    if (count < 5) continue;
    std::vector<Vec3> crossed = moved(loop, {3, 4, 5});
    crossed[static_cast<std::size_t>(count / 2)] += Vec3(5, 0.01, 0);
    EXPECT_FALSE(simple(loop, crossed, direction)) << count;
  }
}

const ElementaryTest& exact() {
  return *find_elementary_test("exact");
}

std::string contacts(Prepared prepared, const Motion& motion, Report& report) {
  ContactSet found;
  report = prepared.detector->detect({motion}, found);
  found.sort();
  return digest(found) + " " + std::to_string(found.contacts.size());
}

// Open ramps wind over themselves and are shaken and squeezed, from gently to wildly.
TEST(Mcd, FindsAllContactsOfOpenSurfaces) {
  std::mt19937_64 random(9);
  std::size_t culled = 0, with_contacts = 0, both = 0;
  for (int round = 0; round < 150; ++round) {
    const double turns = uniform(random, 0.3, 2.2), pitch = uniform(random, 0.2, 1.5);
    Shape shape = test::ramp(static_cast<int>(uniform(random, 10, 40)), turns, 1, 2, pitch);
    const std::vector<Vec3> start = shaken(shape.positions, round % 3 * 0.03, random);
    std::vector<Vec3> end = shaken(start, round % 4 * 0.1, random);
    const double squeeze = uniform(random, -1, 1.2);
    for (Vec3& p : end) p.z() *= squeeze;
    const TriangleMesh mesh = shape.mesh();
    const StrategyInput setup{mesh, start, nullptr, exact()};
    Report by_mcd, by_brute;
    const std::string found = contacts(make_mcd(setup), Motion(start, end), by_mcd);
    const std::string truth = contacts(make_brute(setup), Motion(start, end), by_brute);
    ASSERT_EQ(found, truth) << "round " << round;
    const bool contact = truth.substr(17) != "0", drops = by_mcd.cull.pctp * 2 < by_brute.cull.pctp;
    with_contacts += contact;
    culled += drops;
    both += contact && by_mcd.cull.contour_box_tests > 0;
  }
  EXPECT_GT(with_contacts, 30u);
  EXPECT_GT(culled, 30u);
  EXPECT_GT(both, 20u);
}

}  // namespace
}  // namespace cscd::mcd
