#include "core/fast/certify/parting.h"

#include <cmath>
#include <cstdlib>
#include <gtest/gtest.h>
#include <set>

#include "core/fast/contour/test_touching.h"
#include "core/fast/prepare/test_body.h"

namespace cscd::fast {
namespace {

struct Interval {
  TriangleMesh mesh;
  std::vector<Vec3> start, end;

  // Returns the ordered pairs of triangles that a plane parts, each pair in both orders.
  std::set<std::pair<TriangleId, TriangleId>> parted(decltype(not_parted)& left_of = not_parted) const {
    LocalPositions local(start);
    local.update(motion());
    std::set<std::pair<TriangleId, TriangleId>> found;
    PairLanes lanes;
    std::vector<std::pair<TriangleId, TriangleId>> pairs;  // the pairs in `lanes`
    const auto ask = [&] {
      const Mask16 left = left_of(local.records(), lanes, local.error());
      for (std::size_t l = 0; l < pairs.size(); ++l)
        if ((left >> l & 1) == 0) found.insert(pairs[l]);
      pairs.clear();
    };
    const auto count = static_cast<std::int32_t>(mesh.triangle_count());
    for (std::int32_t i = 0; i < count; ++i)
      for (std::int32_t j = 0; j < count; ++j) {
        if (i == j) continue;
        const TriangleId a{i}, b{j};
        for (std::size_t k = 0; k < 3; ++k) {
          lanes.first[k][pairs.size()] = static_cast<std::int32_t>(mesh.corners(a)[k]);
          lanes.second[k][pairs.size()] = static_cast<std::int32_t>(mesh.corners(b)[k]);
        }
        pairs.emplace_back(a, b);
        if (pairs.size() == kLanes16) ask();
      }
    ask();
    return found;
  }
  Motion motion() const { return Motion(start, end); }
};

// Returns how many corners two triangles share.
std::size_t shared(const TriangleMesh& mesh, TriangleId a, TriangleId b) {
  std::size_t count = 0;
  for (const VertexId v : mesh.corners(a))
    for (const VertexId w : mesh.corners(b)) count += v == w;
  return count;
}

// Vertices of bodies move at random until the bodies touch themselves. Mutations: corners on both sides count
// as on one side; the shared corners are those of the wrong triangle; a pair counts as parted where only some
// corners are on one side.
TEST(Parting, NoPairThatTouchesIsParted) {
  std::size_t met = 0, by_edges = 0, by_shared[3] = {};
  for (int seed = 1; seed <= 5; seed += std::getenv("CSCD_FULL") ? 1 : 2) {
    const test::Body body(0.04 * seed, 2, {3, -2, 1}, 1, seed);
    const Interval interval{body.mesh, body.start, body.end};
    const auto apart = interval.parted(), edges_apart = interval.parted(not_parted_by_edges);
    by_edges += edges_apart.size();
    for (const auto& [a, b] : test::touching(body.mesh, body.motion())) {
      ++met;
      for (const auto* pairs : {&apart, &edges_apart})
        EXPECT_FALSE(pairs->contains({a, b}) || pairs->contains({b, a}))
            << "seed " << seed << ": " << +a << ", " << +b;
    }
    for (const auto& [a, b] : apart) {
      ++by_shared[shared(body.mesh, a, b)];
      EXPECT_TRUE(apart.contains({b, a})) << "either plane may part them";
    }
  }
  EXPECT_GT(met, 1000u);
  EXPECT_GT(by_edges, 1000u);
  for (const std::size_t count : by_shared) EXPECT_GT(count, 1000u);
}

// Rule certain-sign: corners on whole numbers, so that many lie exactly in the plane of another triangle; in
// every other round so far from the first vertex that the numbers round. Mutations: no bound on rounding, of
// planes or of gaps; gaps at one end alone; gaps on either side count together.
TEST(Parting, RuleCertainSignWhatTouchesExactlyIsNotParted) {
  std::mt19937 random(5);
  std::size_t met = 0, apart[2] = {};
  const std::vector<Triangle> triangles = {test::corners(0, 1, 2), test::corners(3, 4, 5),
                                           test::corners(6, 7, 8), test::corners(3, 7, 9),
                                           test::corners(5, 4, 10)};
  for (int round = 0; round < 500; ++round) {
    Interval interval{TriangleMesh(triangles, 11), {}, {}};
    for (std::size_t v = 0; v < 11; ++v)
      for (std::vector<Vec3>* at : {&interval.start, &interval.end}) {
        const auto dice = [&] {
          return (v < 3 || round % 2 == 0 ? 0 : 0x1p24) + static_cast<double>(random() % 8);
        };
        const double x = dice(), y = dice(), z = dice();
        at->emplace_back(x, y, z);
      }
    const std::set<std::pair<TriangleId, TriangleId>> parted[2] = {interval.parted(),
                                                                   interval.parted(not_parted_by_edges)};
    for (std::size_t k = 0; k < 2; ++k) apart[k] += parted[k].size();
    for (const auto& [a, b] : test::touching(interval.mesh, interval.motion())) {
      ++met;
      for (const auto& pairs : parted)
        EXPECT_FALSE(pairs.contains({a, b}) || pairs.contains({b, a})) << round << ": " << +a << ", " << +b;
    }
  }
  EXPECT_GT(met, 300u);
  for (const std::size_t count : apart) EXPECT_GT(count, 100u);
}

// Two triangles whose edges cross at a distance, so that each plane cuts the other triangle. Mutations: the
// directions are at right angles to edges of one triangle alone; edges are taken at the start alone.
TEST(Parting, EdgesThatCrossAtADistancePartTheirTriangles) {
  const auto crossed = [](double gap_at_start, double gap_at_end, double turned) {
    const double c = std::cos(turned), s = std::sin(turned);
    return Interval{
        TriangleMesh(std::vector<Triangle>{test::corners(0, 1, 2), test::corners(3, 4, 5)}, 6),
        {{-1, 0, 0}, {1, 0, 0}, {0, 0, -1}, {0, -1, gap_at_start}, {0, 1, gap_at_start}, {0, 0, 2}},
        {{-c, 0, s}, {c, 0, -s}, {0, 0, -1}, {0, -1, gap_at_end}, {0, 1, gap_at_end}, {0, 0, 2}}};
  };
  EXPECT_TRUE(crossed(0.1, 0.1, 0).parted().empty());
  EXPECT_EQ(crossed(0.1, 0.1, 0).parted(not_parted_by_edges).size(), 2u);
  EXPECT_EQ(crossed(0.1, 0.1, 0.15).parted(not_parted_by_edges).size(), 2u);
  EXPECT_TRUE(crossed(0.1, -0.1, 0).parted(not_parted_by_edges).empty());
}

// A small triangle passes an edge of another one slantwise, and crosses the plane of that one on the way.
// Mutation: directions at right angles to edges alone.
TEST(Parting, EdgesAndTheWayPartTrianglesThatPassEachOther) {
  const auto passing = [](double x) {
    Interval interval{TriangleMesh(std::vector<Triangle>{test::corners(0, 1, 2), test::corners(3, 4, 5)}, 6),
                      {{0, 0, -1}, {0, 0, 1}, {-1, 0, 0}},
                      {{0, 0, -1}, {0, 0, 1}, {-1, 0, 0}}};
    for (const Vec3& corner : {Vec3(0, 0, 0), Vec3(0.01, 0, 0), Vec3(0, 0, 0.01)}) {
      interval.start.push_back(corner + Vec3(x - 1.1, 1.1, 0));
      interval.end.push_back(corner + Vec3(x + 1.1, -1.1, 0));
    }
    return interval;
  };
  EXPECT_TRUE(passing(0.1).parted().empty());
  EXPECT_EQ(passing(0.1).parted(not_parted_by_edges).size(), 2u);
  EXPECT_TRUE(passing(-0.1).parted(not_parted_by_edges).empty());
}

// Two triangles with the same three corners have no other corner, so no plane parts them. Mutation: shared
// corners alone are enough.
TEST(Parting, TwoTrianglesOfOneFaceAreNotParted) {
  const Interval twice{TriangleMesh(std::vector<Triangle>{test::corners(0, 1, 2), test::corners(0, 2, 1)}, 3),
                       {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
                       {{0, 0, 1}, {1, 0, 1}, {0, 1, 1}}};
  EXPECT_TRUE(twice.parted().empty());
}

}  // namespace
}  // namespace cscd::fast
