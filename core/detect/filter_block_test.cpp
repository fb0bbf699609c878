#include "core/detect/filter_block.h"

#include <algorithm>
#include <bit>
#include <gtest/gtest.h>
#include <random>

#include "core/elementary/catalogue.h"
#include "core/elementary/exact/exact.h"
#include "core/elementary/question/test_filter.h"
#include "core/mesh/test_shapes.h"

namespace cscd {

namespace {

// Returns vertices of which some lie nearly or exactly in one plane.
std::vector<Vec3> scattered(std::size_t count, std::mt19937_64& random) {
  std::uniform_real_distribution<double> unit(-1, 1);
  std::vector<Vec3> out;
  for (std::size_t i = 0; i < count; ++i) {
    const double flat = random() % 3 == 0 ? 0 : random() % 3 == 0 ? 1e-13 : 1;
    out.emplace_back(unit(random), unit(random), flat * unit(random));
  }
  return out;
}

TEST(FilterBlock, SaysOfEveryPairWhatItsScalarTwinSays) {
  const TriangleMesh mesh = test::icosphere(1).mesh();
  std::mt19937_64 random(7);
  for (const double scale : {1.0, 1e-160, 1e-90, 1e110}) {
    std::vector<Vec3> start = scattered(mesh.vertex_count(), random),
                      end = scattered(mesh.vertex_count(), random);
    for (Vec3& x : start) x *= scale;
    for (Vec3& x : end) x *= scale;
    const Motion motion(start, end);
    std::vector<FeaturePair> pairs, expected, left;
    for (std::int32_t t = 0; t < static_cast<std::int32_t>(mesh.triangle_count()); ++t)
      for (std::int32_t i = 0; i < static_cast<std::int32_t>(mesh.vertex_count()); ++i) {
        pairs.push_back(FeaturePair::of(VertexId{i}, TriangleId{t}));
        pairs.push_back(FeaturePair::of(EdgeId{i}, EdgeId{t}));
      }                              // at the other scales products leave the range
    pairs.resize(pairs.size() - 3);  // the last block is short
    for (const FeaturePair& pair : pairs) {
      const auto says = [](const auto& query) {
        return never_coplanar(query) || test::never_meet_in_plane(query);
      };
      const bool apart = pair.kind == FeaturePair::Kind::vertex_face
                             ? says(vertex_face(mesh, motion, VertexId{pair.a}, TriangleId{pair.b}))
                             : says(edge_edge(mesh, motion, EdgeId{pair.a}, EdgeId{pair.b}));
      if (!apart) expected.push_back(pair);
    }
    filter(mesh, motion, pairs, left);
    EXPECT_EQ(left, expected) << "scale " << scale;
    if (scale == 1 || scale == 1e-90) {
      EXPECT_LT(left.size(), pairs.size());  // at the others, products leave the range and nothing is certain
    }
  }
}

// Filtering by triangle pairs leaves the same feature pairs, whichever triangle comes first and
// however its corners are turned.
TEST(FilterBlock, LeavesOfTwoTrianglesWhatItLeavesPairByPair) {
  const TriangleMesh mesh = test::icosphere(1).mesh();
  const auto count = static_cast<std::int32_t>(mesh.triangle_count());
  std::mt19937_64 random(13);
  const ElementaryTest& exact_test = *find_elementary_test("filtered_exact");
  for (const double scale : {1.0, 1e-160, 1e-90, 1e110}) {
    std::vector<Vec3> start = scattered(mesh.vertex_count(), random), end = start;
    for (Vec3& x : end) x += 0.1 * scattered(1, random)[0];
    for (Vec3& x : start) x *= scale;
    for (Vec3& x : end) x *= scale;
    const Motion motion(start, end);
    std::size_t dropped = 0, coplanar = 0, kept = 0, kept_in_single = 0;
    for (std::int32_t i = 0; i < count; ++i)
      for (std::int32_t j = 0; j < count; ++j) {
        if (i == j) continue;
        CarriedPairs pairs{{TriangleId{i}, TriangleId{j}}, 0};
        pairs.places = carried_by(mesh.corners(pairs.pair.a), mesh.corners(pairs.pair.b));
        if ((i + j) % 3 == 0) pairs.places &= static_cast<CarriedPlaces>(random());
        std::vector<FeaturePair> features, expected, left;
        for_each_carried(mesh, pairs, [&](const FeaturePair& pair) {
          features.push_back(pair);
          coplanar += pair.kind == FeaturePair::Kind::vertex_face
                          ? !never_coplanar(vertex_face(mesh, motion, VertexId{pair.a}, TriangleId{pair.b}))
                          : !never_coplanar(edge_edge(mesh, motion, EdgeId{pair.a}, EdgeId{pair.b}));
        });
        filter(mesh, motion, features, expected);
        filter(mesh, motion, std::span(&pairs, 1), false, 1, left);
        ASSERT_EQ(left, expected) << i << " and " << j << ", scale " << scale;
        std::vector<FeaturePair> in_single;
        filter(mesh, motion, std::span(&pairs, 1), true, 1, in_single);
        for (const FeaturePair& pair : features)
          if (std::ranges::find(in_single, pair) == in_single.end()) {
            ASSERT_EQ(ask(exact_test, mesh, motion, pair).verdict, Verdict::apart) << i << " and " << j;
          }
        kept_in_single += in_single.size();
        dropped += features.size() - left.size();
        kept += left.size();
      }
    if (scale == 1 || scale == 1e-90) {
      EXPECT_GT(kept, 1000u);
      EXPECT_GT(dropped, coplanar - kept + 1000);
    }
    if (scale == 1) {
      EXPECT_GT(coplanar, kept + 1000);  // the others are apart in their plane
      EXPECT_LT(kept_in_single, kept);   // single precision looks at shorter parts of the interval
    }
  }
}

// Without the error bound, a rounding may decide the sign, and features that touch are dropped.
TEST(FilterBlock, ThePlainSignDropsNoLessAndLosesContacts) {
  const TriangleMesh mesh = test::icosphere(1).mesh();
  std::mt19937_64 random(11);
  std::vector<Vec3> start = scattered(mesh.vertex_count(), random);
  for (Vec3& x : start) x.z() = 0.1 * x.x() + 0.3 * x.y();  // all in one plane, up to rounding
  const Motion motion(start, start);
  std::vector<FeaturePair> touching, certain;
  for (std::int32_t t = 0; t < static_cast<std::int32_t>(mesh.triangle_count()); ++t)
    for (std::int32_t i = 0; i < static_cast<std::int32_t>(mesh.vertex_count()); ++i)
      if (exact::first_contact(vertex_face(mesh, motion, VertexId{i}, TriangleId{t})))
        touching.push_back(FeaturePair::of(VertexId{i}, TriangleId{t}));
  filter(mesh, motion, touching, certain);
  std::vector<FeaturePair> plain = touching;
  drop_by_plain_sign(mesh, motion, plain);
  EXPECT_EQ(certain, touching);
  EXPECT_LT(plain.size(), touching.size());
}

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

// What is dropped, and what is farther apart before some time, is so by the oracle.
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
