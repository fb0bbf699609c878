#include "core/radial/smoothing.h"

#include <gtest/gtest.h>

#include "core/mesh/test_shapes.h"

namespace cscd::radial {
namespace {

using test::Shape;

TEST(Smoothing, NoPassChangesNothing) {
  const Shape shape = test::torus();
  EXPECT_EQ(smoothed(shape.mesh(), shape.positions, 0), shape.positions);
}

TEST(Smoothing, HalvesAnOctahedronAboutItsCentre) {
  // The neighbours of each corner have their mean at the origin.
  const Shape shape = test::octahedron();
  const std::vector<Vec3> result = smoothed(shape.mesh(), shape.positions, 3);
  for (std::size_t v = 0; v < 6; ++v) EXPECT_LE((result[v] - shape.positions[v] / 8).norm(), 1e-15);
}

TEST(Smoothing, FlattensASpikeAndMovesAllAtOnce) {
  Shape shape = test::icosphere(2);
  shape.positions[0] *= 2;
  const TriangleMesh mesh = shape.mesh();
  const std::vector<Vec3> result = smoothed(mesh, shape.positions, 1);
  EXPECT_LT(result[0].norm(), 1.6);
  // Relabelling the vertices relabels the result, because no vertex sees a neighbour that has already moved.
  const auto n = shape.positions.size();
  Shape reversed = shape;
  for (std::size_t v = 0; v < n; ++v) reversed.positions[n - 1 - v] = shape.positions[v];
  for (Triangle& t : reversed.triangles)
    for (VertexId& v : t) v = VertexId{static_cast<std::int32_t>(n - 1 - +v)};
  const std::vector<Vec3> other = smoothed(reversed.mesh(), reversed.positions, 1);
  for (std::size_t v = 0; v < n; ++v) EXPECT_LE((result[v] - other[n - 1 - v]).norm(), 1e-15);
}

TEST(Smoothing, LeavesUnusedVertices) {
  Shape shape = test::octahedron();
  shape.positions.emplace_back(3, 4, 5);
  EXPECT_EQ(smoothed(shape.mesh(), shape.positions, 4)[6], Vec3(3, 4, 5));
}

}  // namespace
}  // namespace cscd::radial
