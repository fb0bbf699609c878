#include <bit>
#include <gtest/gtest.h>
#include <random>

#include "core/detect/filter_block.h"
#include "core/elementary/catalogue.h"

namespace cscd {
namespace {

// Two triangles in random motion that share as many corners as `shared` says, of any size and far from the
// origin.
struct TwoTriangles {
  std::vector<Vec3> start, end;
  TriangleMesh mesh;
  double size;

  TwoTriangles(unsigned seed, int shared)
      : mesh({{{VertexId{0}, VertexId{1}, VertexId{2}},
               {VertexId{shared > 0 ? 0 : 3}, VertexId{shared > 1 ? 1 : 4}, VertexId{5}}}},
             6) {
    std::mt19937 random(seed);
    const auto dice = [&] { return static_cast<double>(random() >> 8) * 0x1p-23 - 1; };
    size = std::ldexp(1.0, static_cast<int>(random() % 40) - 20);
    const Vec3 origin = size * static_cast<double>(random() % 100) * Vec3(dice(), dice(), dice());
    for (int v = 0; v < 6; ++v) {
      const Vec3 side = v < 3 ? Vec3::Zero() : Vec3(0, 0, 1.5 * dice());
      start.push_back(origin + size * (side + Vec3(dice(), dice(), 0.4 * dice())));
      end.push_back(start.back() + 0.5 * size * Vec3(dice(), dice(), dice()));
    }
  }
};

// What is dropped, and what is farther apart before some time, is so by the referee.
// Mutations: no distance; no length of the direction; one end alone; the error bound is zero.
TEST(DistanceFilter, NothingThatComesNearIsDropped) {
  const ElementaryTest& exact = *find_elementary_test("exact");
  std::size_t dropped = 0, close = 0, left = 0, before_counts = 0;
  for (unsigned seed = 0; seed < 1500; ++seed) {
    const TwoTriangles two(seed, static_cast<int>(seed % 3));
    const Motion motion(two.start, two.end);
    const TrianglePair pair{TriangleId{0}, TriangleId{1}};
    const Triangle &a = two.mesh.corners(pair.a), &b = two.mesh.corners(pair.b);
    const double r = two.size * std::exp2(-static_cast<double>(seed % 11));
    const CarriedPlaces places = carried_by(a, b), kept = not_farther_than(r, motion, a, b, places);
    EXPECT_EQ(kept & ~places, 0);
    const float before = no_contact_before(two.mesh, motion, std::span(&pair, 1), r)[0];
    for_each_carried(two.mesh, {pair, places}, [&](const FeaturePair& features) {
      const Answer truth = ask_close(exact, two.mesh, motion, features, r);
      close += truth.verdict == Verdict::contact;
      if (truth.verdict == Verdict::contact) {
        EXPECT_LE(before, truth.time) << "seed " << seed;
        before_counts += before > 0;
      }
    });
    for_each_carried(two.mesh, {pair, static_cast<CarriedPlaces>(places & ~kept)},
                     [&](const FeaturePair& features) {
                       EXPECT_EQ(ask_close(exact, two.mesh, motion, features, r).verdict, Verdict::apart)
                           << "seed " << seed;
                       ++dropped;
                     });
    left += static_cast<std::size_t>(std::popcount(static_cast<unsigned>(kept)));
  }
  EXPECT_GT(close, 2000u);
  EXPECT_GT(dropped, 2000u);
  EXPECT_GT(before_counts, 100u);
  EXPECT_LT(left - close, dropped) << "the filter drops too little to be of use";
}

}  // namespace
}  // namespace cscd
