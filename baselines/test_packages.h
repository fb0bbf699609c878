#pragma once

#include <gtest/gtest.h>

#include "baselines/aabb.h"
#include "scenes/random/random_interval.h"

namespace cscd::test {

// The package reports exactly the pairs of boxes that overlap: as many triangle pairs, the same feature pairs
// and contacts as the hierarchy of boxes, on fresh detectors and on used ones.
inline void expect_the_pairs_of_boxes(Prepared (*make)(const Setup&)) {
  const ElementaryTest& newton = *find_elementary_test("newton");
  std::uint64_t pairs = 0;
  for (std::uint64_t seed = 1; seed <= 110; ++seed) {
    const scenes::RandomInterval random = scenes::make_random_interval(seed);
    const TriangleMesh mesh(random.clip.header().triangles, random.clip.header().vertex_count);
    const Motion there = random.clip.interval(0).motion, back(there.end(), there.start());
    const Setup setup{mesh, there.start(), nullptr, newton};
    const auto package = make(setup).detector, boxes = make_aabb(setup).detector;
    for (const Motion& motion : {there, back, there}) {
      ContactSet found[2];
      const Report a = package->detect(motion, nullptr, found[0]),
                   b = boxes->detect(motion, nullptr, found[1]);
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

}  // namespace cscd::test
