#pragma once

#include <gtest/gtest.h>
#include <random>
#include <vector>

#include "baselines/plain.h"
#include "core/elementary/catalogue.h"
#include "scenes/random/random_interval.h"

namespace cscd::test {

// Expects that the package reports exactly the pairs of boxes that overlap: the same number
// of triangle pairs, and the same feature pairs and contacts as the hierarchy of boxes, on
// fresh detectors and on used ones.
inline void expect_the_pairs_of_boxes(Prepared (*make)(const StrategyInput&)) {
  const ElementaryTest& newton = *find_elementary_test("newton");
  std::uint64_t pairs = 0;
  for (std::uint64_t seed = 1; seed <= 110; ++seed) {
    const scenes::RandomInterval random = scenes::make_random_interval(seed);
    const TriangleMesh mesh(random.clip.header().triangles, random.clip.header().vertex_count);
    const Motion there = random.clip.interval(0).motion, back(there.end(), there.start());
    const StrategyInput setup{mesh, there.start(), nullptr, newton};
    const auto package = make(setup).detector, boxes = make_aabb(setup).detector;
    for (const Motion& motion : {there, back, there}) {
      ContactSet found[2];
      const Report a = package->detect({motion}, found[0]), b = boxes->detect({motion}, found[1]);
      for (ContactSet& set : found) set.sort();
      EXPECT_EQ(a.cull.pctp, b.cull.pctp) << "seed " << seed;
      EXPECT_EQ(a.pairs.adjacent_pctp, b.pairs.adjacent_pctp) << "seed " << seed;
      EXPECT_EQ(a.pairs.feature_pairs, b.pairs.feature_pairs) << "seed " << seed;
      EXPECT_EQ(a.pairs.elementary_tests, b.pairs.elementary_tests) << "seed " << seed;
      EXPECT_EQ(digest(found[0]), digest(found[1])) << "seed " << seed;
      EXPECT_FALSE(a.cull.bvot.has_value());
      pairs += a.cull.pctp;
    }
  }
  EXPECT_GT(pairs, 100000u);
}

// Expects the same for triangles at rest without common vertices. `corners`:
// three positions for each triangle.
inline void expect_the_pairs_of_boxes(Prepared (*make)(const StrategyInput&),
                                      const std::vector<Vec3>& corners) {
  std::vector<Triangle> triangles;
  for (int v = 0; v < static_cast<int>(corners.size()); v += 3)
    triangles.push_back({VertexId{v}, VertexId{v + 1}, VertexId{v + 2}});
  const TriangleMesh mesh(triangles, corners.size());
  const StrategyInput setup{mesh, corners, nullptr, *find_elementary_test("newton")};
  ContactSet found, expected;
  const Report a = make(setup).detector->detect({Motion(corners, corners)}, found),
               b = make_aabb(setup).detector->detect({Motion(corners, corners)}, expected);
  found.sort(), expected.sort();
  EXPECT_GT(b.cull.pctp, 100u);
  EXPECT_EQ(a.cull.pctp, b.cull.pctp);
  EXPECT_EQ(digest(found), digest(expected));
}

// Expects the same for triangles that reach beyond the floats, beside one triangle that does not.
inline void expect_pairs_beyond_floats(Prepared (*make)(const StrategyInput&)) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> anywhere(0, 4), near(-0.5, 0.5);
  for (const double far : {1e30, 1e39, -1e39, 1e300}) {
    std::vector<Vec3> corners;
    for (int t = 0; t < 400; ++t) {
      const Vec3 centre(anywhere(random), anywhere(random), t == 200 ? 0 : far * (1.5 + near(random)));
      for (int k = 0; k < 3; ++k)
        corners.push_back(centre + Vec3(near(random), near(random), t == 200 ? 0 : far * 0.1 * near(random)));
    }
    SCOPED_TRACE(far);
    expect_the_pairs_of_boxes(make, corners);
  }
}

// Expects the same for subnormal triangles that are all apart. Their pairs are so many that some are tested
// while others are still being sought.
inline void expect_pairs_of_subnormal_triangles(Prepared (*make)(const StrategyInput&)) {
  std::vector<Vec3> corners;
  for (int t = 0; t < 260; ++t)
    for (const Vec3& p : {Vec3(0, 0, 0), Vec3(1, 1, 1), Vec3(1, 1.001, 1)})
      corners.push_back(1e-310 * (p + Vec3(0, 0, 1e-3 * t)));
  expect_the_pairs_of_boxes(make, corners);
}

}  // namespace cscd::test
