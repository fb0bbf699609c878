#include "core/elementary/exact/triangles_meet.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace cscd
