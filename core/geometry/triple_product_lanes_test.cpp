#include "core/geometry/triple_product_lanes.h"

#include <cfloat>
#include <gtest/gtest.h>
#include <random>
#include <vector>

namespace cscd {
namespace {

// Compares the signs of eight cubics at once with those of the scalar functions, on everything with which
// those are tested: all magnitudes, cancellation, zeros, overflow and NaN.
TEST(TripleProductLanes, SayWhatTheScalarTwinSays) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> unit(-1, 1);
  const double special[] = {0,
                            -0.0,
                            1,
                            -1,
                            1e-93,
                            1e99,
                            1e154,
                            1.3e154,
                            1e-20,
                            1e300,
                            DBL_MAX,
                            1e-310,
                            1e-140,
                            std::numeric_limits<double>::infinity(),
                            std::numeric_limits<double>::quiet_NaN()};
  int seen[3] = {};
  for (int round = 0; round < 20'000; ++round) {
    VectorLanes a, b, c;
    MovingVector vectors[3][kLanes];
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const Vec3 u(unit(random), unit(random), unit(random)), w(unit(random), unit(random), unit(random));
      for (std::size_t v = 0; v < 3; ++v) {
        const double scale = random() % 3 == 0 ? special[random() % std::size(special)] : 1;
        for (Vec3* end : {&vectors[v][lane].start, &vectors[v][lane].end}) {
          *end = random() % 4 == 0
                     ? Vec3(unit(random) * u + unit(random) * w)
                     : Vec3(u + (v == 0 ? 0.1 : 1.0) * Vec3(unit(random), unit(random), v * 2.0));
          *end *= scale;
          if (random() % 64 == 0)
            (*end)[static_cast<int>(random() % 3)] = special[random() % std::size(special)];
        }
      }
      VectorLanes* const lanes[3] = {&a, &b, &c};
      for (int v = 0; v < 3; ++v)
        for (int i = 0; i < 3; ++i) {
          lanes[v]->at[0][i][lane] = vectors[v][lane].start[i];
          lanes[v]->at[1][i][lane] = vectors[v][lane].end[i];
        }
    }
    const Sign8 signs = certain_signs(cross(a, b), c);
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const int expected = certain_sign(triple_product(vectors[0][lane], vectors[1][lane], vectors[2][lane]));
      ASSERT_EQ(signs[lane], expected) << "lane " << lane;
      ++seen[expected + 1];
    }
  }
  for (const int count : seen) EXPECT_GT(count, 1000);
}

// Vertices are gathered in their lanes, and vectors between them go from the second to the first. Mutations:
// an axis, an end or a lane is taken for another; the difference is turned round.
TEST(TripleProductLanes, VectorsAreThoseBetweenTheVerticesOfTheirLanes) {
  std::vector<Vec3> start, end;
  for (int v = 0; v < 2 * static_cast<int>(kLanes); ++v) {
    start.emplace_back(v, 100 + v * v, 10'000 + 3 * v);
    end.emplace_back(-v, 200 + v, 20'000 + v * v);
  }
  const Motion motion(start, end);
  VertexLanes from, to;
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    from.set(lane, VertexId{static_cast<std::int32_t>(lane)});
    to.set(lane, VertexId{static_cast<std::int32_t>(2 * kLanes - 1 - lane)});
  }
  const VectorLanes vectors = gather(motion, to) - gather(motion, from);
  for (std::size_t lane = 0; lane < kLanes; ++lane)
    for (int i = 0; i < 3; ++i) {
      EXPECT_EQ(vectors.at[0][i][lane], start[2 * kLanes - 1 - lane][i] - start[lane][i]);
      EXPECT_EQ(vectors.at[1][i][lane], end[2 * kLanes - 1 - lane][i] - end[lane][i]);
    }
}

}  // namespace
}  // namespace cscd
