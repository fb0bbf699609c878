#include "core/elementary/exact/triangles_meet.h"

#include <gtest/gtest.h>
#include <random>

#include "core/elementary/exact/static_contact.h"
#include "core/mesh/adjacency.h"

namespace cscd {
namespace {

bool meet(const std::vector<Triangle>& triangles, const std::vector<Vec3>& positions) {
  const TriangleMesh mesh(triangles, positions.size());
  const bool meets = triangles_meet(mesh, positions, TriangleId{0}, TriangleId{1});
  EXPECT_EQ(triangles_meet(mesh, positions, TriangleId{1}, TriangleId{0}), meets);
  return meets;
}

// Two triangles with a common edge are folded onto each other. Their other edges cross, while neither holds
// the other's third corner. Mutation: edges that share a vertex are asked, and not those that share none.
TEST(TrianglesMeet, NeighboursThatAreFoldedShutMeet) {
  const VertexId v{0}, w{1}, p{2}, q{3};
  const std::vector<Triangle> triangles = {{v, w, p}, {w, v, q}};
  std::vector<Vec3> positions = {{0, 0, 0}, {4, 0, 0}, {5, 2, 0}, {-1, 2, 0}};
  EXPECT_TRUE(meet(triangles, positions));
  positions[3].z() = 0x1p-60;  // opened by next to nothing
  EXPECT_FALSE(meet(triangles, positions));
  positions[3] = {-1, -2, 0};
  EXPECT_FALSE(meet(triangles, positions));
}

// Two triangles with one common vertex: an edge of one runs over the side of the other that faces the vertex.
TEST(TrianglesMeet, AnEdgeFromACommonVertexCrossesTheSideThatFacesIt) {
  const VertexId v{0};
  const std::vector<Triangle> triangles = {{v, VertexId{1}, VertexId{2}}, {v, VertexId{3}, VertexId{4}}};
  std::vector<Vec3> positions = {{0, 0, 0}, {4, -1, 0}, {4, 1, 0}, {8, 0, 0}, {8, 0, 1}};
  EXPECT_TRUE(meet(triangles, positions));
  positions[3].z() = 0x1p-60;
  EXPECT_FALSE(meet(triangles, positions));
}

// Whether a point of `b` other than what both share lies on `a`, by the predicates alone, over all features.
bool reaches(const TriangleMesh& mesh, std::span<const Vec3> x, TriangleId a, TriangleId b) {
  const auto at = [&](VertexId v) { return x[static_cast<std::size_t>(v)]; };
  const Triangle& t = mesh.corners(a);
  bool touch = false;
  for (const VertexId v : mesh.corners(b))
    touch |= !contains(t, v) && vertex_touches_triangle(at(v), at(t[0]), at(t[1]), at(t[2]));
  for (const EdgeId e : mesh.edges_of(b)) {
    const Edge& edge = mesh.ends(e);
    if (!contains(t, edge[0]) && !contains(t, edge[1]))
      touch |= segment_touches_triangle(at(edge[0]), at(edge[1]), at(t[0]), at(t[1]), at(t[2]));
    for (const EdgeId f : mesh.edges_of(a)) {
      const Edge& other = mesh.ends(f);
      touch |=
          !share_vertex(edge, other) && segments_touch(at(edge[0]), at(edge[1]), at(other[0]), at(other[1]));
    }
  }
  return touch;
}

// Most triangles on a coarse grid are degenerate, coplanar or touch. Mutations: a vertex in the plane counts
// as beside it; sides that differ count as one.
TEST(TrianglesMeet, AsTheirFeaturesDoOnACoarseGrid) {
  std::mt19937 random(7);
  std::uniform_int_distribution<int> coordinate(0, 2);
  std::size_t meeting = 0, apart = 0;
  for (int round = 0; round < 60'000; ++round) {
    const int shared = round % 3;
    const VertexId v[] = {VertexId{0}, VertexId{1}, VertexId{2}, VertexId{3}, VertexId{4}, VertexId{5}};
    const std::vector<Triangle> triangles = {{v[0], v[1], v[2]},
                                             {v[shared > 1 ? 1 : 3], v[shared > 0 ? 0 : 4], v[5]}};
    std::vector<Vec3> positions(6);
    for (Vec3& p : positions)
      for (int k = 0; k < 3; ++k) p[k] = coordinate(random);
    const TriangleMesh mesh(triangles, positions.size());
    const bool expected = reaches(mesh, positions, TriangleId{0}, TriangleId{1}) ||
                          reaches(mesh, positions, TriangleId{1}, TriangleId{0});
    ASSERT_EQ(meet(triangles, positions), expected) << "round " << round;
    ++(expected ? meeting : apart);
  }
  EXPECT_GT(meeting, 10'000u);
  EXPECT_GT(apart, 10'000u);
}

}  // namespace
}  // namespace cscd
