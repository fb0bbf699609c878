#include "core/fast/prepare/patch_cutter.h"

#include <chrono>
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>
#include <random>
#include <set>

#include "core/mesh/test_shapes.h"

namespace cscd::fast {
namespace {

struct Surface {
  test::Shape shape;
  TriangleMesh mesh = shape.mesh();
  std::vector<Vec3> centroid;
  explicit Surface(test::Shape given = test::icosphere(4, 1)) : shape(std::move(given)) {
    for (const Triangle& c : mesh.triangles())
      centroid.push_back((shape.positions[+c[0]] + shape.positions[+c[1]] + shape.positions[+c[2]]) / 3);
  }
  std::vector<TriangleId> all() const {
    std::vector<TriangleId> all;
    for (std::size_t t = 0; t < mesh.triangle_count(); ++t)
      all.push_back(TriangleId{static_cast<std::int32_t>(t)});
    return all;
  }
  PatchCutter::Patches cut(std::span<const TriangleId> cell) const {
    return PatchCutter(mesh, centroid).cut(cell);
  }
};

void expect_valid(const Surface& surface, const std::vector<TriangleId>& cell,
                  const PatchCutter::Patches& patches) {
  std::multiset<TriangleId> met;
  for (const auto& patch : patches) {
    EXPECT_GT(patch.size(), 0u);
    EXPECT_LE(patch.size(), 16u);
    std::set<VertexId> vertices;
    for (const TriangleId t : patch) {
      met.insert(t);
      vertices.insert(surface.mesh.corners(t).begin(), surface.mesh.corners(t).end());
    }
    EXPECT_LE(vertices.size(), 16u);
  }
  EXPECT_EQ(met, std::multiset<TriangleId>(cell.begin(), cell.end()));
}

// Mutations: small patches are not emptied, or only where there is room at once; triangles move into a patch
// that another triangle leaves for their sake; the number of vertices has no limit.
TEST(PatchCutter, FillsPatches) {
  const Surface surface;
  const std::vector<TriangleId> all = surface.all();
  const PatchCutter::Patches patches = surface.cut(all);
  expect_valid(surface, all, patches);
  EXPECT_LE(static_cast<double>(patches.size()), static_cast<double>(all.size()) / (0.97 * 16));
}

// Mutation: patches grow over edges alone.
TEST(PatchCutter, KeepsTogetherWhatHangsByItsCorners) {
  const Surface surface;
  const VertexId centre{0};
  std::vector<TriangleId> fan;  // every second triangle at a vertex; no two share an edge
  std::set<VertexId> taken;
  for (const TriangleId t : surface.mesh.triangles_at(centre)) {
    const Triangle& c = surface.mesh.corners(t);
    const auto is_taken = [&](VertexId v) { return v != centre && taken.contains(v); };
    if (std::any_of(c.begin(), c.end(), is_taken)) continue;
    taken.insert(c.begin(), c.end());
    fan.push_back(t);
  }
  ASSERT_GE(fan.size(), 2u);
  const PatchCutter::Patches patches = surface.cut(fan);
  expect_valid(surface, fan, patches);
  EXPECT_EQ(patches.size(), 1u);
}

// In cells that are full of holes many triangles are left over. Mutation: room is counted without the
// triangle that comes.
TEST(PatchCutter, KeepsAllTrianglesWhereManyMove) {
  const Surface surface;
  std::mt19937 random(5);
  for (const double share : {0.3, 0.5, 0.7, 0.9}) {
    std::vector<TriangleId> cell = surface.all();
    std::erase_if(cell, [&](TriangleId) { return std::bernoulli_distribution(1 - share)(random); });
    expect_valid(surface, cell, surface.cut(cell));
  }
}

test::Shape book(int pages) {
  test::Shape shape{{{0, 0, 0}, {0, 1, 0}}, {}};
  for (int page = 0; page < pages; ++page) {
    const double angle = 2 * std::numbers::pi * page / pages;
    shape.positions.emplace_back(std::cos(angle), 0.5, std::sin(angle));
    shape.triangles.push_back(test::corners(0, 1, 2 + page));
  }
  return shape;
}

// Many triangles share one edge, so each has more than three neighbours. Mutation: three is taken for the
// largest number of neighbours.
TEST(PatchCutter, CutsWhatIsNoManifold) {
  const Surface surface(book(40));
  expect_valid(surface, surface.all(), surface.cut(surface.all()));
}

// Mutations: the free triangles at an edge are counted whenever their number is needed; all patches beside an
// edge are asked for room.
TEST(PatchCutter, TakesLittleTimeWhereThousandsMeet) {
  const Surface surface(book(6000));
  const auto begin = std::chrono::steady_clock::now();
  expect_valid(surface, surface.all(), surface.cut(surface.all()));
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(5));
}

}  // namespace
}  // namespace cscd::fast
