#include "core/fast/prepare/saved_cut.h"

#include <algorithm>
#include <functional>
#include <gtest/gtest.h>
#include <limits>

#include "core/base/error.h"
#include "core/base/test_refusal.h"
#include "core/fast/prepare/carried_cut.h"
#include "core/fast/prepare/test_body.h"

namespace cscd::fast {
namespace {

struct SavableCut : test::Body, CutSurface {
  SavableCut() : test::Body(0.01, 0), CutSurface(cut_surface(mesh, shape.positions, atomic.of_triangle)) {}
  std::vector<std::byte> saved() const { return saved_cut(mesh, shape.positions, *this, 2); }
  RestoredCut restored(std::span<const std::byte> bytes) const {
    return restored_cut(mesh, shape.positions, bytes);
  }
};

// Mutations: a cover is left out; the cells are not kept; heights are not kept.
TEST(SavedCut, IsTheCutThatWasSaved) {
  SavableCut cut;
  cut.covers[1].observers[0].stand_off(0.5F);
  const auto [again, covers, new_triangles] = cut.restored(cut.saved());
  EXPECT_EQ(covers, 2u);
  ASSERT_EQ(again.tree.patches.size(), cut.tree.patches.size());
  for (std::size_t p = 0; p < again.tree.patches.size(); ++p) {
    EXPECT_EQ(again.tree.triangles[p], cut.tree.triangles[p]);
    EXPECT_EQ(again.tree.patches[p].vertex, cut.tree.patches[p].vertex);
    EXPECT_EQ(again.tree.patches[p].cluster, cut.tree.patches[p].cluster);
    EXPECT_EQ(again.tree.inside[p], cut.tree.inside[p]);
    EXPECT_EQ(again.tree.leaf[p], cut.tree.leaf[p]);
    EXPECT_EQ(again.tree.cell[p], cut.tree.cell[p]);
  }
  EXPECT_EQ(again.tree.adjacent, cut.tree.adjacent);
  for (std::size_t c = 0; c < kCovers; ++c) {
    EXPECT_EQ(again.covers[c].cluster_of, cut.covers[c].cluster_of);
    ASSERT_EQ(again.covers[c].observers.size(), cut.covers[c].observers.size());
    for (std::size_t i = 0; i < cut.covers[c].observers.size(); ++i)
      EXPECT_EQ(again.covers[c].observers[i].at(cut.start), cut.covers[c].observers[i].at(cut.start));
  }
}

// Mutation: the digest of the contents is not compared.
TEST(SavedCut, DamagedOnesAreRefused) {
  const SavableCut cut;
  const std::vector<std::byte> whole = cut.saved();
  for (std::size_t i = 0; i < whole.size(); i += i < 64 ? 1 : 997) {
    std::vector<std::byte> changed = whole;
    changed[i] ^= std::byte{4};
    EXPECT_THROW(cut.restored(changed), InputError) << i;
    EXPECT_THROW(cut.restored(std::span(whole).first(i)), InputError) << i;
  }
  std::vector<std::byte> longer = whole;
  longer.push_back({});
  EXPECT_THROW(cut.restored(longer), InputError);
}

// Mutation: the digest of the surface is not compared.
TEST(SavedCut, KnowsWhatIsNewOnAnotherSurface) {
  SavableCut cut;
  const std::vector<std::byte> saved = cut.saved();
  EXPECT_EQ(cut.restored(saved).new_triangles, 0u);
  cut.shape.positions[5].x() += 1e-12;
  EXPECT_EQ(cut.restored(saved).new_triangles, cut.mesh.triangles_at(VertexId{5}).size());
}

// What the theorems ask of a cut is checked even where the bytes are whole. Mutations: each of the checks.
TEST(SavedCut, OneThatBreaksARuleIsRefused) {
  const auto expect_refused = [](const char* what, const std::function<void(SavableCut&)>& spoil) {
    SavableCut cut;
    spoil(cut);
    EXPECT_NE(test::refusal([&] { cut.restored(cut.saved()); }).find(what), std::string::npos);
  };
  expect_refused("a triangle in two patches",
                 [](SavableCut& cut) { cut.tree.triangles[0][0] = cut.tree.triangles[1][0]; });
  expect_refused("a patch in two clusters", [](SavableCut& cut) {
    std::swap(cut.covers[0].cluster_of[+cut.tree.triangles[0][0]],
              cut.covers[0].cluster_of[+cut.tree.triangles.back()[0]]);
  });
  expect_refused("a triangle without a cluster", [](SavableCut& cut) {
    for (const TriangleId t : cut.tree.triangles_of(0)) cut.covers[0].cluster_of[+t] = kNone;
  });
  expect_refused("a wrong cluster", [](SavableCut& cut) {
    for (const TriangleId t : cut.tree.triangles_of(0)) cut.covers[0].cluster_of[+t] = 1 << 20;
  });
  expect_refused("an empty cluster",
                 [](SavableCut& cut) { cut.covers[0].observers.emplace_back(cut.covers[0].observers[0]); });
  expect_refused("too large weights", [](SavableCut& cut) {
    cut.covers[1].observers[0] = {};
    cut.covers[1].observers[0].add(VertexId{0}, 1e9F);
  });
  expect_refused("a wrong observer", [](SavableCut& cut) { cut.covers[1].observers[0] = {}; });
  for (const float height : {1e30F, -2000.0F, std::numeric_limits<float>::quiet_NaN()})
    expect_refused("a wrong observer",
                   [&](SavableCut& cut) { cut.covers[1].observers[0].stand_off(height); });
}

// Places of vertices are saved, so one that follows no vertex cannot be.
TEST(SavedCut, AnObserverAtAVertexThatTheMeshLacksIsRefused) {
  SavableCut cut;
  for (const int vertex : {-1, 1 << 20}) {
    cut.covers[1].observers[0] = {};
    cut.covers[1].observers[0].add(VertexId{vertex}, 1);
    const std::string text = test::refusal([&] { check(cut.mesh, {2, cut.covers, {}}); });
    EXPECT_NE(text.find("a vertex that the mesh lacks"), std::string::npos) << vertex;
  }
}

TEST(SavedCut, AClusterInTwoComponentsIsRefused) {
  const test::Shape pair = test::together(test::icosphere(1), test::moved(test::icosphere(1), {5, 0, 0}, 1));
  const TriangleMesh mesh = pair.mesh();
  std::vector<std::int32_t> cluster_of;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t)
    cluster_of.push_back(mesh.component(TriangleId{static_cast<std::int32_t>(t)}));
  CutSurface cut = cut_surface(mesh, pair.positions, cluster_of);
  EXPECT_NO_THROW(restored_cut(mesh, pair.positions, saved_cut(mesh, pair.positions, cut, 1)));
  for (std::int32_t& cluster : cut.covers[0].cluster_of) cluster = 0;
  cut.covers[0].observers.resize(1);
  EXPECT_THROW(restored_cut(mesh, pair.positions, saved_cut(mesh, pair.positions, cut, 1)), InputError);
}

}  // namespace
}  // namespace cscd::fast
