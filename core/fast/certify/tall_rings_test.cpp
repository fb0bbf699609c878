#include "core/fast/certify/tall_rings.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <random>
#include <set>

#include "core/detect/carried_pairs.h"
#include "core/fast/prepare/cut_surface.h"
#include "core/fast/prepare/test_body.h"

namespace cscd::fast {
namespace {

// A tube in which triangles are tall or not by chance, and the rings by their definitions, triangle by
// triangle.
struct TallTube : test::Body {
  CutSurface cut;
  TallRings rings;
  std::vector<std::array<bool, kCovers>> tall;  // [triangles]

  TallTube(unsigned seed, double share)
      : test::Body(0.02, 3),
        cut(cut_surface(mesh, shape.positions, atomic.of_triangle)),
        rings(mesh, cut.tree) {
    std::mt19937 random(seed);
    tall.resize(mesh.triangle_count());
    rings.start(kCovers);
    for (std::size_t p = 0; p < cut.tree.patches.size(); ++p)
      for (std::size_t c = 0; c < kCovers; ++c) {
        Mask16 some = 0;
        for_each_lane(cut.tree.patches[p].lanes, [&](std::size_t lane) {
          if (cut.tree.patches[p].cluster[c] == kNone || static_cast<double>(random()) * 0x1p-32 < share)
            return;
          tall[+cut.tree.triangles[p][lane]][c] = true;
          some |= static_cast<Mask16>(1U << lane);
        });
        rings.take(p, c, some);
      }
  }
  std::set<TriangleId> round(const std::set<VertexId>& vertices) const {
    std::set<TriangleId> out;
    for (const VertexId v : vertices)
      for (const TriangleId t : mesh.triangles_at(v)) out.insert(t);
    return out;
  }
  bool tall_in_one_cluster(const std::set<TriangleId>& all, std::size_t c) const {
    const auto cluster = [&](TriangleId t) { return cut.covers[c].cluster_of[static_cast<std::size_t>(+t)]; };
    return std::ranges::all_of(all, [&](TriangleId t) {
      return cluster(t) != kNone && cluster(t) == cluster(*all.begin()) &&
             tall[static_cast<std::size_t>(+t)][c];
    });
  }
  std::set<VertexId> vertices_of(const FeaturePair& pair, bool first) const {
    const auto set = [](const auto& all) { return std::set<VertexId>(std::begin(all), std::end(all)); };
    if (pair.kind == FeaturePair::Kind::edge_edge) return set(mesh.ends(EdgeId{first ? pair.a : pair.b}));
    return first ? std::set{VertexId{pair.a}} : set(mesh.corners(TriangleId{pair.b}));
  }
  // Returns whether two features are near on the surface, and the vertices round which the theorem asks for
  // tall triangles.
  std::pair<bool, std::set<VertexId>> asked(const FeaturePair& pair) const {
    const std::set<VertexId> a = vertices_of(pair, true), b = vertices_of(pair, false);
    std::set<VertexId> all = a;
    all.insert(b.begin(), b.end());
    bool near = false;
    for (const TriangleId t : round(a)) {
      const Triangle& corner = mesh.corners(t);
      if (std::ranges::none_of(corner, [&](VertexId v) { return b.contains(v); })) continue;
      near = true;
      all.insert(corner.begin(), corner.end());
    }
    return {near, all};
  }
};

std::set<std::pair<TriangleId, TriangleId>> unsettled_pairs(TallRings& rings) {
  std::set<std::pair<TriangleId, TriangleId>> out;
  rings.find_unsettled();
  rings.for_each_unsettled_pair([&](TriangleId a, TriangleId b) { out.emplace(std::minmax(a, b)); });
  return out;
}

// "Theorem: tall rings", its condition.
// Mutations: one ring settles instead of two; rings are spread once instead of twice, or not at all;
// triangles outside the cluster count as inside.
TEST(TallRings, WhatIsSettledHasTallTrianglesAllRoundIt) {
  std::size_t settled = 0, unsettled = 0;
  unsigned seed = 0;
  for (const double share : {0.0, 0.002, 0.01, 0.03}) {
    TallTube tube(++seed, share);
    const std::set<std::pair<TriangleId, TriangleId>> left = unsettled_pairs(tube.rings);
    unsettled += left.size();
    const NearTriangles near(tube.mesh);
    for (std::size_t t = 0; t < tube.mesh.triangle_count(); ++t) {
      const TriangleId a{static_cast<std::int32_t>(t)};
      for (const TriangleId b : near.of(a)) {
        if (b < a || left.contains({a, b})) continue;
        ++settled;
        for_each_carried(tube.mesh, TrianglePair{a, b}, [&](const FeaturePair& pair) {
          const auto [are_near, vertices] = tube.asked(pair);
          if (!are_near) return;
          const std::set<TriangleId> all = tube.round(vertices);
          bool proven = false;
          for (std::size_t c = 0; c < kCovers; ++c) proven |= tube.tall_in_one_cluster(all, c);
          EXPECT_TRUE(proven) << "triangles " << +a << " and " << +b << ", seed " << seed;
        });
      }
    }
  }
  EXPECT_GT(settled, 3 * unsettled);
  EXPECT_GT(unsettled, 1000u);
}

// Mutation: rings that lie inside clusters stay those of the old clusters.
TEST(TallRings, LieInsideTheClustersThatThereAreNow) {
  TallTube tube(7, 0);
  std::vector<Patch>& patches = tube.cut.tree.patches;
  const auto all_tall = [&](TallRings& rings) {
    rings.start(1);
    for (std::size_t p = 0; p < patches.size(); ++p) rings.take(p, 0, patches[p].lanes);
    return unsettled_pairs(rings);
  };
  const auto before = all_tall(tube.rings);
  const auto added = static_cast<std::int32_t>(tube.cut.covers[0].observers.size());
  for (std::size_t p = patches.size() / 2; p < patches.size(); ++p) patches[p].cluster[0] = added;
  tube.rings.forget_clusters();
  TallRings fresh(tube.mesh, tube.cut.tree);
  EXPECT_EQ(all_tall(tube.rings), all_tall(fresh));
  EXPECT_GT(all_tall(fresh).size(), before.size());
}

// Mutations: rings are not spread; what is spoiled later is left in.
TEST(TallRings, AOneRingIsWhatIsTallAndNotSpoiledAllRound) {
  TallTube tube(5, 0.01);
  std::mt19937 random(6);
  for (std::size_t p = 0; p < tube.cut.tree.patches.size(); p += 7) {
    const auto lane = random() % tube.cut.tree.triangles_of(p).size();
    tube.rings.spoil(p, 0, static_cast<Mask16>(1U << lane));
    tube.tall[static_cast<std::size_t>(+tube.cut.tree.triangles[p][lane])][0] = false;
  }
  tube.rings.find_one_rings();
  std::size_t one_rings = 0, others = 0;
  for (std::size_t p = 0; p < tube.cut.tree.patches.size(); ++p)
    for (std::size_t c = 0; c < kCovers; ++c)
      for_each_lane(tube.cut.tree.patches[p].lanes, [&](std::size_t lane) {
        const Triangle& corner = tube.mesh.corners(tube.cut.tree.triangles[p][lane]);
        const bool one_ring = tube.tall_in_one_cluster(tube.round({corner.begin(), corner.end()}), c);
        EXPECT_EQ((tube.rings.one_rings(p, c) >> lane & 1) != 0, one_ring)
            << "patch " << p << ", cover " << c;
        ++(one_ring ? one_rings : others);
      });
  EXPECT_GT(one_rings, 500u);
  EXPECT_GT(others, 500u);
}

}  // namespace
}  // namespace cscd::fast
