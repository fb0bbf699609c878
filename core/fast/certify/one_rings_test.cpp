#include "core/fast/certify/one_rings.h"

#include <cstdlib>
#include <gtest/gtest.h>
#include <random>

#include "core/detect/carried_pairs.h"
#include "core/detect/start/embedding.h"
#include "core/elementary/catalogue.h"
#include "core/fast/prepare/test_body.h"
#include "core/mesh/adjacency.h"

namespace cscd::fast {
namespace {

const ElementaryTest& exact() {
  return *find_elementary_test("exact");
}

// Counts the feature pairs of triangles of the one-ring of a vertex that touch, or come within r.
std::size_t contacts_in_one_ring(const TriangleMesh& mesh, const Motion& motion, VertexId vertex,
                                 double r = 0) {
  std::size_t contacts = 0;
  const std::span<const TriangleId> one_ring = mesh.triangles_at(vertex);
  for (std::size_t i = 0; i < one_ring.size(); ++i)
    for (std::size_t j = i + 1; j < one_ring.size(); ++j)
      for_each_carried(mesh, TrianglePair{one_ring[i], one_ring[j]}, [&](const FeaturePair& pair) {
        contacts += ask_close(exact(), mesh, motion, pair, r).verdict != Verdict::apart;
      });
  return contacts;
}

// Vertices move at random, up to where neighbours run into each other. Mutations: the error bound is zero on
// flat surfaces; the sign of the direction is wrong; the end of the interval is ignored.
TEST(OneRings, TrianglesOfAFlatOneRingDoNotTouch) {
  std::size_t flat = 0, others_with_contacts = 0, embedded = 0;
  for (int seed = 1; seed <= 12; ++seed) {
    const double noise = 0.02 * seed;
    test::Body body(0, 1);
    const test::Body noisy(noise, 1, {100, -50, 25}, 1, seed);
    for (std::size_t v = 0; v < body.start.size(); ++v) body.start[v] += Vec3(100, -50, 25);
    body.end = noisy.end;
    embedded += EmbeddingTest(body.mesh, body.start).embedded(body.start);
    LocalPositions local(body.start);
    local.update(body.motion());
    const OneRings one_rings(body.mesh);
    for (std::size_t v = 0; v < body.mesh.vertex_count(); v += 3) {
      const VertexId vertex{static_cast<std::int32_t>(v)};
      const std::size_t contacts = contacts_in_one_ring(body.mesh, body.motion(), vertex);
      if (one_rings.flat(vertex, local)) {
        ++flat;
        EXPECT_EQ(contacts, 0u) << "seed " << seed << ", vertex " << v;
      } else {
        others_with_contacts += contacts > 0;
      }
    }
  }
  EXPECT_EQ(embedded, 12u);
  EXPECT_GT(flat, 500u);
  EXPECT_GT(others_with_contacts, 20u);
}

// At a thickness, no features of a flat one-ring come closer than it. Mutations: heights are not looked at;
// the longest edge is that at one end alone; only edges at the vertex count; the last control vector is
// ignored.
TEST(OneRings, FeaturesOfAFlatOneRingKeepItsHeight) {
  std::size_t settled = 0, close = 0;
  for (int seed = 1; seed <= 12; seed += std::getenv("CSCD_FULL") ? 1 : 2) {
    test::Body body(0, 1);
    const test::Body noisy(0.02 * seed, 1, {}, 1, seed);
    body.end = noisy.end;
    std::mt19937 random(static_cast<unsigned>(seed));
    LocalPositions local(body.start);
    local.update(body.motion());
    const OneRings one_rings(body.mesh);
    for (std::size_t v = 0; v < body.mesh.vertex_count(); v += 3) {
      const VertexId vertex{static_cast<std::int32_t>(v)};
      // From far below an edge's length to above it.
      const double r = std::exp2(1 - 6 * static_cast<double>(random()) * 0x1p-32);
      const bool kept = one_rings.flat(vertex, local, local.in_local(r));
      settled += kept;
      const std::size_t found = contacts_in_one_ring(body.mesh, body.motion(), vertex, r);
      close += found > 0 && one_rings.flat(vertex, local);
      if (kept) {
        EXPECT_EQ(found, 0u) << "seed " << seed << ", vertex " << v << ", r " << r;
      }
    }
  }
  EXPECT_GT(settled, 300u);
  EXPECT_GT(close, 300u);
}

// A hexagon of radius 1 has heights of 0.87. It is stretched until these are smaller by as much as its edges
// get longer, or seen slantwise. Mutations: the edge opposite to the vertex does not count; the direction is
// taken for one of unit length.
TEST(OneRings, AStretchedOneRingKeepsItsLeastHeight) {
  for (const double stretch : {1.0, 4.0})
    for (const double slope : {0.0, 1.0}) {
      test::Shape one_ring{{{0, 0, 0}}, {}};
      for (int i = 0; i < 6; ++i) {
        const double angle = std::numbers::pi / 3 * i, x = stretch * std::cos(angle);
        one_ring.positions.emplace_back(x, std::sin(angle), slope * std::sin(angle));
        one_ring.triangles.push_back(test::corners(0, 1 + i, 1 + (i + 1) % 6));
      }
      const TriangleMesh mesh = one_ring.mesh();
      LocalPositions local(one_ring.positions);
      local.update(Motion(one_ring.positions, one_ring.positions));
      double least = 10;  // seen along the one-ring's own normal
      for (std::size_t i = 0; i < 6; ++i) {
        const Vec3 a = one_ring.positions[1 + i], b = one_ring.positions[1 + (i + 1) % 6];
        least = std::min(least, a.cross(b).norm() / std::max({a.norm(), b.norm(), (b - a).norm()}));
      }
      EXPECT_TRUE(OneRings(mesh).flat(VertexId{0}, local, local.in_local(0.999 * least)));
      EXPECT_FALSE(OneRings(mesh).flat(VertexId{0}, local, local.in_local(1.001 * least)));
    }
}

// The one-rings round a tip that is turned inside out are no graphs all the time. Mutation: only the ends of
// the interval are tested.
TEST(OneRings, ATipThatTurnsOverIsNotFlat) {
  test::Shape shape = test::octahedron();
  std::vector<Vec3> end = shape.positions;
  end[4] = {0, 0, -0.5};
  const TriangleMesh mesh = shape.mesh();
  LocalPositions local(shape.positions);
  local.update(Motion(shape.positions, end));
  const OneRings one_rings(mesh);
  EXPECT_TRUE(one_rings.flat(VertexId{4}, local)) << "it stays a graph over its base";
  EXPECT_FALSE(one_rings.flat(VertexId{0}, local));
}

// Triangles without area prove nothing.
TEST(OneRings, DegenerateTrianglesAreNotFlat) {
  test::Shape shape = test::octahedron();
  shape.positions[4] = shape.positions[0];
  const TriangleMesh mesh = shape.mesh();
  LocalPositions local(shape.positions);
  local.update(Motion(shape.positions, shape.positions));
  const OneRings one_rings(mesh);
  for (const int v : {0, 2, 3, 4}) EXPECT_FALSE(one_rings.flat(VertexId{v}, local));
  EXPECT_TRUE(one_rings.flat(VertexId{1}, local));
}

// A hexagon of radius r has triple products of 0.87 r^2. Let e be the error of a coordinate, which a far
// vertex sets. The edges' largest components are up to r and 0.87 r, and the proof in one_rings.cpp takes
// each for 2 e longer. So the products are off by up to 12.2 e (1.87 r + 4 e), and r has to exceed 28.3 e.
// Mutation: an edge counts as exact.
TEST(OneRings, RuleErrorBoundOneThatIsNearlyAsSmallAsTheErrorIsNotFlat) {
  for (const auto& [errors, flat] :
       {std::pair(4.0, false), {8, false}, {16, false}, {27.8, false}, {29, true}, {60, true}}) {
    test::Shape one_ring{{{0, 0, 0}}, {}};
    const double r = errors * 0x1p-24;  // the scale is such that the far vertex is one unit away
    for (int i = 0; i < 6; ++i) {
      const double angle = std::numbers::pi / 3 * i;
      one_ring.positions.emplace_back(r * std::cos(angle), r * std::sin(angle), 0);
      one_ring.triangles.push_back(test::corners(0, 1 + i, 1 + (i + 1) % 6));
    }
    one_ring.positions.emplace_back(1, 1, 1);
    one_ring.triangles.push_back(test::corners(1, 3, 7));
    const TriangleMesh mesh = one_ring.mesh();
    LocalPositions local(one_ring.positions);
    local.update(Motion(one_ring.positions, one_ring.positions));
    EXPECT_NEAR(static_cast<double>(local.error()), 0x1p-24, 0x1p-40);
    EXPECT_EQ(OneRings(mesh).flat(VertexId{0}, local), flat) << errors;
  }
}

// Mutation: the turns of the one-ring are not counted.
TEST(OneRings, OneThatGoesRoundTwiceIsNotFlat) {
  for (const int turns : {1, 2}) {
    test::Shape one_ring{{{0, 0, 0}}, {}};
    constexpr int kCorners = 12;
    for (int i = 0; i < kCorners; ++i) {
      const double angle = 2 * std::numbers::pi * turns * i / kCorners;
      const double wave = std::cos(angle / turns), r = 1 + 0.2 * wave;
      one_ring.positions.emplace_back(r * std::cos(angle), r * std::sin(angle), 0.1 * wave);
      one_ring.triangles.push_back(test::corners(0, 1 + i, 1 + (i + 1) % kCorners));
    }
    const TriangleMesh mesh = one_ring.mesh();
    std::vector<Vec3> end = one_ring.positions;
    for (Vec3& p : end) p.z() = -p.z();
    const Motion motion(one_ring.positions, end);
    LocalPositions local(one_ring.positions);
    local.update(motion);
    EXPECT_EQ(contacts_in_one_ring(mesh, motion, VertexId{0}) > 0, turns == 2);
    EXPECT_EQ(OneRings(mesh).flat(VertexId{0}, local), turns == 1);
  }
}

// A one-ring goes round twice. The test looks for the triangles that contain the direction through the middle
// of the first triangle. Here that direction differs by only 1e-5 from the direction along which the one-ring
// would be a graph, so the cross product of the two is mostly rounding. Mutation: the steepness is not
// compared with the lengths that it is computed from.
TEST(OneRings, OneThatGoesRoundTwiceIsNotFlatThoughItsFirstTriangleIsSteep) {
  const test::Shape one_ring{{{0, 0, 0},
                              {0x1.366f6cdbc7008p+0, 0x1.35b6052755bdp-4, 0x1.356d878345b19p-1},
                              {0x1.8e8275e05a704p-2, 0x1.4dbbc23c065c8p-1, -0x1.1ff156d7a51dep+0},
                              {0x1.599abe689d6e8p-2, 0x1.24ca7364082f2p+0, 0x1.c2480c9349aap-3},
                              {0x1.5a470666d66eep+0, -0x1.8164ddf34ed78p-2, -0x1.897c3532aaa44p-1},
                              {0x1.94d96cfb0358cp-3, 0x1.e9510f478002ap-2, -0x1.c2687261135d9p-1},
                              {0x1.3f8bb60c30954p-2, 0x1.6a386675acdb6p-1, -0x1.3d8770d5f6b8p-7}},
                             {test::corners(0, 1, 2), test::corners(0, 2, 3), test::corners(0, 3, 4),
                              test::corners(0, 4, 5), test::corners(0, 5, 6), test::corners(0, 6, 1)}};
  const TriangleMesh mesh = one_ring.mesh();
  std::vector<Vec3> end = one_ring.positions;
  for (const std::size_t v : {2, 5, 6}) end[v] *= 2;
  const Motion motion(one_ring.positions, end);
  LocalPositions local(one_ring.positions);
  local.update(motion);
  ASSERT_GT(contacts_in_one_ring(mesh, motion, VertexId{0}), 0u);
  EXPECT_FALSE(OneRings(mesh).flat(VertexId{0}, local));
}

// The corners make half a turn in straight lines, and one corner passes the centre early. The one-ring is
// flat at both ends but not in between. Mutation: the middle control vectors are ignored.
TEST(OneRings, OneThatFoldsInBetweenIsNotFlat) {
  test::Shape one_ring{{{0, 0, 0}}, {}};
  std::vector<Vec3> end = one_ring.positions;
  constexpr int kCorners = 6;
  for (int i = 0; i < kCorners; ++i) {
    const double angle = 2 * std::numbers::pi * i / kCorners, r = i == 0 ? 1.8 : 0.5;
    one_ring.positions.emplace_back(std::cos(angle), std::sin(angle), 0.1 * std::cos(angle));
    end.emplace_back(-r * std::cos(angle), -r * std::sin(angle), 0.05 * std::sin(angle));
    one_ring.triangles.push_back(test::corners(0, 1 + i, 1 + (i + 1) % kCorners));
  }
  const TriangleMesh mesh = one_ring.mesh();
  const Motion motion(one_ring.positions, end);
  const OneRings one_rings(mesh);
  const auto flat = [&](const Motion& of) {
    LocalPositions local(one_ring.positions);
    local.update(of);
    return one_rings.flat(VertexId{0}, local);
  };
  EXPECT_TRUE(flat(Motion(one_ring.positions, one_ring.positions)));
  EXPECT_TRUE(flat(Motion(end, end)));
  EXPECT_GT(contacts_in_one_ring(mesh, motion, VertexId{0}), 0u);
  EXPECT_FALSE(flat(motion));
}

// A one-ring of one closed fan is flat. Nothing is proven of other one-rings. Mutations: the first of two
// fans stands for the whole one-ring; an open fan is closed by a triangle that does not exist.
TEST(OneRings, OneOfTwoFansIsNotFlat) {
  constexpr int kCorners = 6;
  for (const int fan : {kCorners, kCorners - 1})
    for (const int standing : {0, 1, 3}) {
      test::Shape one_ring{{{0, 0, 0}}, {}};
      for (int i = 0; i < kCorners; ++i) {
        const double angle = 2 * std::numbers::pi * i / kCorners;
        one_ring.positions.emplace_back(std::cos(angle), std::sin(angle), 0);
      }
      for (int i = 0; i < fan; ++i)
        one_ring.triangles.push_back(test::corners(0, 1 + i, 1 + (i + 1) % kCorners));
      for (int i = 0; i < 3; ++i) {
        const double angle = 2 * std::numbers::pi * i / 3;
        one_ring.positions.emplace_back(0.3 * std::cos(angle), 0.3 * std::sin(angle), 1);
      }
      for (int i = 0; i < standing; ++i)
        one_ring.triangles.push_back(test::corners(0, 1 + kCorners + i, 1 + kCorners + (i + 1) % 3));
      LocalPositions local(one_ring.positions);
      local.update(Motion(one_ring.positions, one_ring.positions));
      EXPECT_EQ(OneRings(one_ring.mesh()).flat(VertexId{0}, local), fan == kCorners && standing == 0)
          << fan << " triangles, and " << standing;
    }
}

TEST(OneRings, AnOpenOneIsNotFlat) {
  const test::Shape strip = test::ramp(8, 0.5, 1, 2, 0);
  const TriangleMesh mesh = strip.mesh();
  LocalPositions local(strip.positions);
  local.update(Motion(strip.positions, strip.positions));
  const OneRings one_rings(mesh);
  for (std::int32_t v = 0; v < 27; ++v)
    EXPECT_EQ(one_rings.flat(VertexId{v}, local), v % 3 == 1 && v > 2 && v < 24) << v;
}

}  // namespace
}  // namespace cscd::fast
